"""Translate sentences of operators into the language of Blender's interface, with the names and numbers in them.

A sentence is looked up by its text with `{}` in place of names and numbers. So callers write English sentences and need
not know about translations.
"""
from __future__ import annotations

import re
from collections.abc import Iterable

import bpy
from bpy.app.translations import pgettext_iface, pgettext_rpt

from .gathered import ALSO, gathered

DEEPEST = 3     # sentences inside sentences
FIELD = re.compile(r"\{(\w*)\}")
ANYTHING, NUMBERS = "(.*?)", r"([\d., ]+?)"
SHORT = 16      # letters: a part of a sentence, with numbers alone in it, since names may be made of the same words

NEXT = ": "     # stands between the parts of a stage

_known: list[tuple[re.Pattern, str, list[str]]] = []
_stages: list[tuple[re.Pattern, str]] = []


def know_sentences(sentences: Iterable[str]) -> None:
    """Register the sentences that `translated` recognises, in place of those that were registered before.

    A message is recognised if it is equal to a sentence except at the placeholders. It is then shown as Blender's
    translation of that sentence, with the texts from the message in place of the placeholders.

    Parameters
    ----------
    sentences : iterable of str
        English sentences. A placeholder, `{}` or `{name}`, stands for any text. In phrases of up to 16 letters that
        contain no colon and do not end with a full stop, it stands for numbers only, except `{names}`.
    """
    _known.clear()
    # first those that say most by themselves
    for sentence in sorted(sentences, key=lambda sentence: (sentence != ALSO, -len(FIELD.sub("", sentence)))):
        letters = sum(map(str.isalpha, FIELD.sub("", sentence)))
        part = 0 < letters <= SHORT and ":" not in sentence and not sentence.endswith(".")
        # texts and the names of the fields between them take turns
        pieces = FIELD.split(sentence)
        pieces[::2] = map(re.escape, pieces[::2])
        pieces[1::2] = [NUMBERS if part and name != "names" else ANYTHING for name in pieces[1::2]]
        _known.append((re.compile("".join(pieces), re.DOTALL), sentence, FIELD.findall(sentence)))


def one_or_more(count: int, one: str, many: str, **more) -> str:
    """Return `one` for a count of one, else `many`, with `{count}` and the names in `more` filled in."""
    return (one if count == 1 else many).format(count=count, **more)


def tell(operator: bpy.types.Operator, kinds: set[str], sentence: str) -> None:
    """Translate a sentence into the language of Blender's interface and report it.

    Parameters
    ----------
    operator : bpy.types.Operator
    kinds : set of str
        Types of the report as in `Operator.report`, such as {"WARNING"}.
    sentence : str
        English sentence. It is shown unchanged if `know_sentences` has not registered it, or it has no translation.
    """
    operator.report(kinds, translated(sentence))


def tell_done(operator: bpy.types.Operator, done: list[str], remarks: list[str]) -> None:
    """Report the results `done`, and then the `remarks`, each kind once. The most important one comes last, since the
    status bar shows it. All of them are in the Info editor.
    """
    for sentence in done:
        tell(operator, {"INFO"}, sentence)
    for remark in reversed(gathered(remarks)):
        tell(operator, {"WARNING"}, remark)


def translated(sentence: str, depth: int = 0) -> str:
    """Return a sentence in the interface's language if it is known, else unchanged. Sentences and phrases in place of
    names are translated too.
    """
    for pattern, english, names in _known if depth < DEEPEST else ():
        found = pattern.fullmatch(sentence)
        if found is None:
            continue
        translation = pgettext_rpt(english)
        if translation == english and english != "{}: {}":
            return sentence
        parts = [translated(part, depth + 1) for part in found.groups()]
        return translation.format(*parts, **{name: part for name, part in zip(names, parts) if name})
    return sentence


def know_stages(stages: Iterable[str]) -> None:
    """Register translatable names of stages, which are recognised from now on; `{}` are names and numbers."""
    _stages.clear()
    for stage in sorted(stages, key=lambda stage: -len(FIELD.sub("", stage))):
        _stages.append((re.compile("(.+?)".join(map(re.escape, stage.split("{}")))), stage))


def translated_stage(stage: str) -> str:
    """Return the name of a stage, such as "Frame 2: Mirror: clipping", in the interface's language. Names stay
    unchanged.
    """
    return NEXT.join(map(_translated_part, stage.split(NEXT)))


def _translated_part(part: str) -> str:
    for pattern, english in _stages:
        found = pattern.fullmatch(part)
        if found is not None:
            return pgettext_iface(english).format(*map(_translated_part, found.groups()))
    return part
