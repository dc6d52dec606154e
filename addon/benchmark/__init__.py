"""The benchmark: every method at every value of its knob, judged by Cycles, with the report that tells of it."""
from .case import Case, read_case
from .options import Options
from .scene_report import scene_report
from .whole_report import write_benchmark

__all__ = ["Case", "Options", "read_case", "scene_report", "write_benchmark"]
