"""The way to the manual, and its pages as the extension carries them."""
from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import urldefrag, urlsplit
from urllib.request import url2pathname

import bpy
import pytest
from markdown_it import MarkdownIt

from tools.manual_pages import PAGES
from tools.markdown import anchor, to_html

DOCS = Path(__file__).resolve().parents[3] / "docs"


class Page(HTMLParser):
    """What a page names, and where it leads."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.named, self.led, self.shown = set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list) -> None:
        given = dict(attrs)
        self.named.add(given.get("id"))
        self.led += [given["href"]] if tag == "a" else []
        self.shown += [given["src"]] if tag == "img" else []


@pytest.fixture
def manual(room) -> Path:
    """Where the installed extension has its manual."""
    address, _ = room("addon.interface.manual").pages()
    assert address.startswith("file:")
    return Path(url2pathname(urlsplit(address).path))


def test_it_tells_of_operators_settings_and_roles(manual, room):
    page, (_, names) = Page(manual), room("addon.interface.manual").pages()
    assert names and {place.removeprefix("#") for _, place in names} <= page.named


@pytest.mark.parametrize(("name", "place"), [
    *((f"bpy.ops.reflection_mesh.{name}", "operators") for name in ("generate", "light", "bake", "print_sheet")),
    ("bpy.types.ReflectionScene.tolerance", "settings"), ("bpy.types.ReflectionObject.tolerance", "settings"),
    ("bpy.types.ReflectionObject.role", "roles"), ("bpy.types.ReflectionLive.eye", "operators")])
def test_blender_finds_it(manual, name, place):
    """By the names that buttons and settings have where Blender looks for its own manual."""
    found = bpy.types.WM_OT_doc_view_manual._lookup_rna_url(name, verbose=False)
    assert found == f"{manual.as_uri()}#{place}"


def test_every_link_leads_to_what_the_extension_carries(manual):
    pages = {path.name: Page(path) for path in manual.parent.glob("*.html")}
    assert len(pages) > 10
    for name, page in pages.items():
        for address, place in map(urldefrag, page.led):
            if not urlsplit(address).scheme:
                target = pages[address or name]
                assert not place or place in target.named, (name, address, place)
        assert all((manual.parent / path).is_file() for path in page.shown)
    pictures = {path.name for path in (manual.parent / "pictures").iterdir()}
    assert pictures == {Path(path).name for page in pages.values() for path in page.shown}


@pytest.mark.parametrize("name", PAGES)
def test_pages_are_what_a_complete_converter_makes(name):
    text = (DOCS / f"{name}.md").read_text(encoding="utf-8")
    expected = MarkdownIt("commonmark").enable("table").render(text)
    without_names = re.sub(r'(<h\d) id="[^"]*">', r"\1>", to_html(text))
    assert without_names == expected


def test_nothing_is_left_of_the_way_it_is_written(manual):
    for path in manual.parent.glob("*.html"):
        text = re.sub(r"<(style|pre|code)>.*?</\1>", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        assert not re.search(r"\]\(|\*\*|^#|^\|", text, flags=re.MULTILINE), path.name


def test_without_its_pages_no_name_has_a_place(room, monkeypatch, tmp_path):
    place = room("addon.interface.manual")
    monkeypatch.setattr(place, "CARRIED", tmp_path / "manual.html")
    assert place.pages() == ("", ())


@pytest.mark.parametrize(("heading", "name"), [("What else they ask for", "what-else-they-ask-for"),
                                               ("The window: `VIRTUAL`", "the-window-virtual")])
def test_headings_are_called_as_where_documents_are_read_else(heading, name):
    assert anchor(heading) == name
