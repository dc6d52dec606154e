"""The documents as pages that a browser reads, which the extension's zip carries: its manual needs no network."""
from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import urlsplit

from .markdown import link_tag, to_html

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
    texts = {name: (docs / f"{name}.md").read_text(encoding="utf-8") for name in PAGES}
    titles = {name: text.partition("\n")[0].lstrip("# ") for name, text in texts.items()}

    def link(address: str, text: str) -> str:
        target = page_address(address)
        return text if target is None else link_tag(target, titles.get(text.removesuffix(".md"), text))

    for name, title in titles.items():
        text = to_html(texts[name], link)
        others = " &middot; ".join(heading if other == name else f'<a href="{other}.html">{heading}</a>'
                                   for other, heading in titles.items())
        files[f"{name}.html"] = PAGE.format(title=title, style=STYLE, others=others, text=text).encode()
        files |= {path: (docs / path).read_bytes() for path in re.findall('<img src="([^"]*)"', text)}
    return files


def page_address(address: str) -> str | None:
    """Return the address, among the pages, of what a document links to; None if it is not among them."""
    parts = urlsplit(address)
    if parts.scheme or not parts.path:
        return address
    name, _, kind = parts.path.rpartition(".")
    if kind != "md" or name not in PAGES:
        return None
    return f"{name}.html#{parts.fragment}" if parts.fragment else f"{name}.html"
