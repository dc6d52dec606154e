"""What light that mirrors throw lacks, in sentences for the user."""
from __future__ import annotations

from ..illumination import Caustic, is_sheared, let_through, light_of_nodes
from ..reading import DiffuseScene


def remarks_on(prepared: list[Caustic], unknown: list) -> list[str]:
    """What is left out of light that is `prepared`, on receivers some of whose materials' colours are `unknown`."""
    remarks = [f"The colour of '{material.name}' is not known all over, where it asks for what only its own "
               "object knows or its shaders send light back in another way than diffuse: its light may have "
               "another colour." for material in dict.fromkeys(unknown)]
    for lamp in dict.fromkeys(made.lamp for made in prepared):
        if lamp.type == "LIGHT" and not light_of_nodes(lamp.data)[1]:
            remarks.append(f"The nodes of '{lamp.name}' tell more than one colour and one strength: its light counts "
                           "as if the rest were plugged off.")
        if is_sheared(lamp):
            remarks.append(f"The lamp '{lamp.name}' is sheared: mirrors throw what they show of it, while Cycles "
                           "lights directly with more or less than that; apply the scale of its parent.")
    if not all(made.plain for made in prepared):
        remarks.append("A mirror's colour that changes over it in a way that only the mirror knows, or that light "
                       "meets after another mirror, counts as one: plug it off to choose which.")
    return remarks


def remarks_on_lit(scene: DiffuseScene) -> list[str]:
    """Where light ends in the scene that would go on."""
    return [f"Light ends at '{material.name}', though some of it would go through: it does so where one number tells "
            "how much, and for two such sheets." for material in let_through(scene)]
