"""The documents as pages that a browser reads, which the extension's zip carries: its manual needs no network."""
from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import urlsplit

from markdown_it import MarkdownIt
from markdown_it.token import Token

STYLE = """
body { max-width: 54em; margin: 2em auto; padding: 0 1em; font: 16px/1.5 sans-serif; color: #222; background: #fff }
nav { border-bottom: 1px solid #bbb; padding-bottom: .5em; font-size: 14px }
img { max-width: 100% }
table { border-collapse: collapse }
td, th { border: 1px solid #bbb; padding: .25em .6em; text-align: left; vertical-align: top }
code { background: #eee; padding: 0 .2em }
pre { background: #eee; padding: .6em; overflow-x: auto }
@media (prefers-color-scheme: dark) {
  body { color: #ddd; background: #222 }
  a { color: #8bf }
  code, pre { background: #333 }
}
"""
PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>{title} - Reflection Mesh</title><style>{style}</style></head>
<body>
<nav>{others}</nav>
{text}</body>
</html>
"""
# by which readers go on, in this order
PAGES = ("manual", "tutorials", "light", "caustics", "animation", "live", "lines", "anamorphosis", "files", "limits",
         "judging", "results")


def manual_pages(docs: Path) -> dict[str, bytes]:
    """The pages of a folder of documents, and the pictures that they show, by their paths from the manual's folder.

    A link to what is not among them becomes its text: who has the extension need not have its sources.
    """
    files: dict[str, bytes] = {}
    reader = MarkdownIt("commonmark").enable("table")
    titles = {name: (docs / f"{name}.md").read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
              for name in PAGES}
    for name, title in titles.items():
        tokens = reader.parse((docs / f"{name}.md").read_text(encoding="utf-8"))
        _name_headings(tokens)
        for token in tokens:
            if token.children:
                token.children = _with_own_links(token.children, titles)
                for shown in (child for child in token.children if child.type == "image"):
                    path = str(shown.attrs["src"])
                    files[path] = (docs / path).read_bytes()
        others = " &middot; ".join(heading if other == name else f'<a href="{other}.html">{heading}</a>'
                                   for other, heading in titles.items())
        text = reader.renderer.render(tokens, reader.options, {})
        files[f"{name}.html"] = PAGE.format(title=title, style=STYLE, others=others, text=text).encode()
    return files


def anchor(heading: str) -> str:
    """What a heading is called in an address, as where the documents are read else."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def _name_headings(tokens: list[Token]) -> None:
    for opening, inner in zip(tokens, tokens[1:]):
        if opening.type == "heading_open":
            opening.attrSet("id", anchor(inner.content))


def _with_own_links(children: list[Token], titles: dict[str, str]) -> list[Token]:
    """What stands in a line, with links among the pages, which are called by their titles."""
    kept, dropped = [], []
    for token in children:
        if token.type == "link_open":
            target = _target(str(token.attrs["href"]))
            dropped.append(target is None)
            if target is not None:
                token.attrSet("href", target)
        elif token.type == "text" and dropped and not dropped[-1]:
            token.content = titles.get(token.content.removesuffix(".md"), token.content)
        leaves = token.type in ("link_open", "link_close") and dropped[-1]
        if token.type == "link_close":
            dropped.pop()
        if not leaves:
            kept.append(token)
    return kept


def _target(address: str) -> str | None:
    """Where a link leads among the pages; None where it leads to what is not there."""
    parts = urlsplit(address)
    if parts.scheme or not parts.path:
        return address
    name, _, kind = parts.path.rpartition(".")
    if kind != "md" or name not in PAGES:
        return None
    return f"{name}.html#{parts.fragment}" if parts.fragment else f"{name}.html"
