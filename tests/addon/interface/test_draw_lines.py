"""Sentences in panels are read to their end, however narrow the panel is and whatever the language."""
from types import SimpleNamespace

import bpy
import blf
import pytest

AT_FIRST = 292  # pixels, the sidebar's width before anybody has changed it, and the least one that has tabs
ICON_AND_MARGINS = 87   # of these, as measured in a window


def drawn(room, text: str, width: int | None) -> list[tuple[str, str]]:
    """What is drawn in a region of that width: lines with their icons."""
    lines: list = []
    layout = SimpleNamespace(label=lambda text, icon, translate: lines.append((text, icon)))
    region = None if width is None else SimpleNamespace(width=width)
    context = SimpleNamespace(region=region, preferences=bpy.context.preferences)
    room("addon.interface.draw_lines").draw_sentence(layout, context, text, icon="TIME")
    return lines


@pytest.mark.parametrize("width", [AT_FIRST, 190])
def test_a_long_sentence_is_drawn_in_lines_that_fit(room, width):
    text = "The mirror 'Golden Ball' is hidden: show it in the viewport and in renders."
    lines = drawn(room, text, width)
    assert len(lines) > 1 and " ".join(line for line, _ in lines) == text
    assert [icon for _, icon in lines] == ["TIME"] + ["BLANK1"] * (len(lines) - 1)
    blf.size(0, bpy.context.preferences.ui_styles[0].widget.points)
    assert all(blf.dimensions(0, line)[0] <= width - ICON_AND_MARGINS for line, _ in lines)


def test_what_fits_is_one_line_and_a_word_is_never_divided(room):
    assert drawn(room, "Exact, 66 ms", AT_FIRST) == [("Exact, 66 ms", "TIME")]
    assert drawn(room, "One sentence of any length where nobody looks.", None) == [
        ("One sentence of any length where nobody looks.", "TIME")]
    name = "'" + 60 * "x" + "'"
    assert [line for line, _ in drawn(room, f"The {name} is", AT_FIRST)] == ["The", name, "is"]
