"""Convert the documents' Markdown to HTML with Python's own modules, so that a build needs nothing else.

Supports the part of CommonMark (https://spec.commonmark.org) that `docs` uses, and tables: headings, paragraphs, lists
of one level, indented code, code spans, emphasis, links and images. A test compares the output with that of a complete
converter.
"""
from __future__ import annotations

import html
import re
from collections.abc import Callable

LINE_KINDS = (("heading", re.compile(r"#{1,6} ")), ("table", re.compile(r"\|")), ("code", re.compile(r" {4}")),
              ("ul", re.compile(r"[-*] ")), ("ol", re.compile(r"\d+\. ")))
DIVIDER = re.compile(r"\|( *:?-+:? *\|)+")
INLINE = re.compile(r"(?P<ticks>`+)(?P<code>.+?)(?P=ticks)(?!`)"
                    r"|!\[(?P<alt>[^\]]*)\]\((?P<source>[^)]*)\)"
                    r"|\[(?P<text>(?:[^\[\]]|\[[^\]]*\])*)\]\((?P<address>[^)]*)\)"
                    r"|\*\*\*(?=\S)(?P<both>.+?)(?<=\S)\*\*\*"
                    r"|\*\*(?=\S)(?P<strong>.+?)(?<=\S)\*\*"
                    r"|\*(?=\S)(?P<em>(?:`[^`]*`|[^*])+?)(?<=\S)\*"
                    r"|\\(?P<escaped>[!-/:-@\[-`{-~])", re.DOTALL)

Link = Callable[[str, str], str]


def escape(text: str) -> str:
    """Replace the characters that have a meaning in HTML."""
    return html.escape(text, quote=False).replace('"', "&quot;")


def anchor(heading: str) -> str:
    """Return the fragment of a heading's address, by the rule of the sites that show Markdown files."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def link_tag(address: str, text: str) -> str:
    """Return the HTML of a link; `text` is HTML already."""
    return f'<a href="{escape(address)}">{text}</a>'


def to_html(markdown: str, link: Link = link_tag) -> str:
    """Convert a document to the HTML of its body.

    Parameters
    ----------
    markdown
        The document's text.
    link
        Called with the address and the HTML text of each link, returns the HTML to show for it.
    """
    lines = markdown.splitlines()
    parts = []
    while lines:
        kind, block = _first_block(lines)
        lines = lines[len(block):]
        if kind == "heading":
            marks, _, heading = block[0].partition(" ")
            level = len(marks)
            parts.append(f'<h{level} id="{anchor(heading)}">{inline(heading, link)}</h{level}>')
        elif kind == "table":
            parts.append(_table(block, link))
        elif kind == "code":
            parts.append(_code(block))
        elif kind in ("ul", "ol"):
            parts.append(f"<{kind}>\n{_items(kind, block, link)}\n</{kind}>")
        elif kind == "paragraph":
            parts.append(f"<p>{inline(_joined(block), link)}</p>")
    return "\n".join(parts) + "\n"


def inline(text: str, link: Link = link_tag) -> str:
    """Convert code spans, emphasis, links and images in one piece of text."""
    parts, end = [], 0
    for found in INLINE.finditer(text):
        parts.append(escape(text[end:found.start()]))
        end = found.end()
        group = found.groupdict()
        if group["code"] is not None:
            code = group["code"].replace("\n", " ")
            parts.append(f"<code>{escape(code)}</code>")
        elif group["source"] is not None:
            parts.append(f'<img src="{escape(group["source"])}" alt="{escape(group["alt"])}" />')
        elif group["address"] is not None:
            parts.append(link(group["address"], inline(group["text"], link)))
        elif group["escaped"] is not None:
            parts.append(escape(group["escaped"]))
        elif group["both"] is not None:
            parts.append(f"<em><strong>{inline(group['both'], link)}</strong></em>")
        else:
            tag = "strong" if group["strong"] is not None else "em"
            parts.append(f"<{tag}>{inline(group[tag], link)}</{tag}>")
    return "".join(parts) + escape(text[end:])


def _kind(line: str) -> str:
    if not line.strip():
        return "blank"
    return next((kind for kind, start in LINE_KINDS if start.match(line)), "paragraph")


def _first_block(lines: list[str]) -> tuple[str, list[str]]:
    """Return the kind of the block that begins with the first line, and its lines."""
    kind, end = _kind(lines[0]), 1
    if kind in ("heading", "blank"):
        return kind, lines[:1]
    while end < len(lines):
        following = _kind(lines[end])
        if kind in ("ul", "ol"):
            # blank lines stay inside if the list goes on behind them
            rest = next((line for line in lines[end:] if line.strip()), "")
            inside = _kind(rest) == kind or rest.startswith("  ") or following == "paragraph"
        elif kind == "code":
            inside = following == "code"
        elif kind == "table":
            inside = following == "table"
        else:
            inside = following in ("paragraph", "code")
        if not inside:
            break
        end += 1
    return kind, lines[:end]


def _joined(lines: list[str]) -> str:
    return "\n".join(line.strip() for line in lines)


def _code(lines: list[str]) -> str:
    return f"<pre><code>{escape(chr(10).join(line[4:] for line in lines))}\n</code></pre>"


def _table(lines: list[str], link: Link) -> str:
    assert DIVIDER.fullmatch(lines[1].strip()), lines[1]
    aligned = [" style=\"text-align:right\"" if cell.endswith(":") else "" for cell in _cells(lines[1])]

    def row(line: str, tag: str) -> str:
        cells = "\n".join(f"<{tag}{style}>{inline(cell, link)}</{tag}>"
                          for cell, style in zip(_cells(line), aligned))
        return f"<tr>\n{cells}\n</tr>"

    body = "\n".join(row(line, "td") for line in lines[2:])
    return f"<table>\n<thead>\n{row(lines[0], 'th')}\n</thead>\n<tbody>\n{body}\n</tbody>\n</table>"


def _cells(line: str) -> list[str]:
    return [cell.strip().replace(r"\|", "|") for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]


def _items(kind: str, lines: list[str], link: Link) -> str:
    """Return the items of a list. Its texts are paragraphs if blank lines stand between them."""
    items: list[list[str]] = []
    for line in lines:
        if _kind(line) == kind:
            marker, _, text = line.partition(" ")
            indent = " " * (len(marker) + 1)
            items.append([text])
        else:
            items[-1].append(line.removeprefix(indent))
    loose = any(not line for line in lines[:-1])
    return "\n".join(f"<li>\n{to_html(chr(10).join(item), link)}</li>" if loose
                     else f"<li>{inline(_joined(item), link)}</li>" for item in items)
