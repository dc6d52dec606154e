"""Pages, plots and pictures of a report, from plain data to files that open anywhere."""
from .colour_map import heat_map
from .png_file import png_bytes, png_picture
from .report_data import (
    LEAST,
    Cost,
    Growth,
    Picture,
    Report,
    Run,
    Scene,
    csv_text,
    document,
    flat,
    number,
    pareto,
    run_rows,
)
from .report_page import page
from .report_plots import plot_files

__all__ = ["Cost", "Growth", "LEAST", "Picture", "Report", "Run", "Scene", "csv_text", "document", "flat", "heat_map",
           "number", "page", "pareto", "plot_files", "png_bytes", "png_picture",
           "run_rows"]
