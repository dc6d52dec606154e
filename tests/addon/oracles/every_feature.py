"""Proof that a run of tests used every operator, every verb and every feature: `pytest --every-feature`.

Operators and verbs are recorded while tests use them; only those that finish count. Features are named by the mark
`feature` of the test that checks them.
"""
from __future__ import annotations

import argparse
import functools
from collections.abc import Callable
from types import ModuleType

import bpy
import pytest

FEATURES = frozenset(("installation", "generate", "light", "caustics", "lines", "points", "several bounces", "live",
                      "frames", "anamorphosis", "compare"))


class EveryFeature:
    """A plugin of pytest that records what tests use, and fails the run if something was never used."""

    def __init__(self, command_line: ModuleType, verbs: ModuleType) -> None:
        self._used: set[str] = set()
        self._wanted = {f"feature {name}" for name in FEATURES}
        for name in dir(bpy.ops.reflection_mesh):
            self._wanted.add(f"operator {name}")
            self._record_operator(f"operator {name}", getattr(bpy.types, f"REFLECTION_MESH_OT_{name}"))
        names = next(action for action in verbs._parser()._actions if isinstance(action, argparse._SubParsersAction))
        self._wanted |= {f"verb {name}" for name in names.choices}
        command_line.run = verbs.run = self._recorded_run(verbs.run)

    @property
    def missing(self) -> list[str]:
        """Sorted names of the features that no test has used so far."""
        return sorted(self._wanted - self._used)

    def _record_operator(self, name: str, operator: type) -> None:
        execute = operator.execute

        @functools.wraps(execute)
        def recorded(self_: bpy.types.Operator, context: bpy.types.Context) -> set:
            outcome = execute(self_, context)
            if "FINISHED" in outcome:
                self._used.add(name)
            return outcome

        operator.execute = recorded

    def _recorded_run(self, run: Callable[..., int]) -> Callable[..., int]:
        def recorded(arguments: list[str], scene: str | None = None) -> int:
            status = run(arguments, scene)
            if status == 0 and arguments:
                self._used.add(f"verb {arguments[0]}")
            return status
        return recorded

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call" and report.passed:
            self._used |= {f"feature {name}" for key, name in report.user_properties if key == "feature"}

    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        item.user_properties += [("feature", mark.args[0]) for mark in item.iter_markers("feature")]

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        if self.missing and session.exitstatus == pytest.ExitCode.OK:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter) -> None:
        if self.missing:
            terminalreporter.section("no test that ran uses", red=True)
            terminalreporter.line(", ".join(self.missing))
