"""What nodes ask of the object and of the camera, answered on a stand-in before another eye as on the object itself."""
from __future__ import annotations

import bpy
import numpy as np

from ....core import View
from ...reading.materials import all_nodes
from ...reading.meshes import questions
from ...writing import UV_MAP
from ...writing.nodes.shader_builder import ShaderBuilder

RANDOM = f"{UV_MAP} Random"
"""Property of stand-ins for instances, whose number goes by no name: one more than that, 0 where it is missing."""
# nodes that tell of what is baked, or shine, otherwise than on the object itself
ASKING = {"OBJECT_INFO", "TEX_COORD", "CAMERA", "LIGHT_PATH", "NEW_GEOMETRY", "FRESNEL", "LAYER_WEIGHT", "EMISSION",
          "BSDF_PRINCIPLED", "ATTRIBUTE", "PARTICLE_INFO", "UVMAP"}
LONGEST = 63  # characters of a property's name


def answer_name(question: tuple[str, str]) -> str:
    """The property of stand-ins that answers what is asked of an instance or its object, as `questions` tell it."""
    return f"{UV_MAP} {question[0]} {question[1]}"[:LONGEST]


def own_groups(tree: bpy.types.NodeTree) -> list:
    """Let a tree have copies of the groups that ask for what is answered otherwise, and return these."""
    made: dict = {}
    _take_copies(tree, made)
    return list(made.values())


def _take_copies(tree: bpy.types.NodeTree, made: dict) -> None:
    for node in [node for node in tree.nodes if node.type == "GROUP" and node.node_tree is not None]:
        group = node.node_tree
        if group not in made:
            if not any(other.type in ASKING for other in all_nodes(group)):
                continue
            made[group] = group.copy()
            _take_copies(made[group], made)
        node.node_tree = made[group]


def answer_truly(tree: bpy.types.NodeTree, view: View) -> None:
    """Let the nodes of a tree tell of an instance what is random by it, what it and its instancer are asked for, and of
    `view` what goes by the camera, though what is baked is seen from elsewhere."""
    build = _Answers(tree)
    for node in list(tree.nodes):
        for question in questions(node):
            build.look_up(node, question)
        if node.type == "OBJECT_INFO":
            build.replace(node.outputs["Random"], build.random)
        elif node.type == "TEX_COORD":
            build.replace(node.outputs["Camera"], lambda _: build.in_camera(view))
            build.replace(node.outputs["Window"], lambda _: build.in_window(view))
        elif node.type == "CAMERA":
            build.replace(node.outputs["View Vector"], lambda _: build.vector("NORMALIZE", build.in_camera(view)))
            build.replace(node.outputs["View Z Depth"], lambda _: build.depth(view))
            build.replace(node.outputs["View Distance"], lambda _: build.vector("LENGTH", build.in_camera(view)))


class _Answers(ShaderBuilder):
    """Answers as sockets."""

    def replace(self, output: bpy.types.NodeSocket, answer) -> None:
        """Let what an output feeds be fed by what `answer` makes of it."""
        sockets = [link.to_socket for link in output.links]
        if sockets:
            told = answer(output)
            for socket in sockets:
                self.feed(told, socket)

    def look_up(self, node: bpy.types.Node, question: tuple[str, str]) -> None:
        """Let a node tell what the stand-in's property says."""
        name = answer_name(question)
        if node.type == "ATTRIBUTE":
            node.attribute_type, node.attribute_name = "OBJECT", name
        else:
            told = self.add("ShaderNodeAttribute", attribute_type="OBJECT", attribute_name=name).outputs
            output = node.outputs[question[1]]
            self.replace(output, lambda _: told["Vector" if output.type == "VECTOR" else "Fac"])

    def random(self, of_name: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """Of an instance, its own number; else that which goes by the name."""
        told = self.add("ShaderNodeAttribute", attribute_type="OBJECT", attribute_name=RANDOM).outputs["Fac"]
        instanced = self.calculated("GREATER_THAN", told, 0.5)
        return self.calculated("ADD", self.calculated("SUBTRACT", told, instanced),
                               self.calculated("MULTIPLY", of_name, self.calculated("SUBTRACT", 1.0, instanced)))

    def in_camera(self, view: View) -> bpy.types.NodeSocket:
        """Where a point is, as the camera counts: to the right, up and ahead."""
        return self.combined(*(self._place(row) for row in _ahead(view)[:3]))

    def depth(self, view: View) -> bpy.types.NodeSocket:
        return self._place(_ahead(view)[2])

    def in_window(self, view: View) -> bpy.types.NodeSocket:
        """Where in the picture a point is, from its lower left corner to the upper right one."""
        clip = view.projection @ np.linalg.inv(view.camera_to_world)
        ahead = self._place(clip[3])
        return self.combined(*(self.calculated("DIVIDE", self._place(0.5 * (clip[axis] + clip[3])), ahead)
                               for axis in (0, 1)), 0.0)

    def _place(self, row: np.ndarray) -> bpy.types.NodeSocket:
        """A linear function of where a point is."""
        position = self.add("ShaderNodeNewGeometry").outputs["Position"]
        return self.calculated("ADD", self.dot(position, tuple(row[:3].tolist())), float(row[3]))


def _ahead(view: View) -> np.ndarray:
    """From the world to the camera, whose third axis is the one along which it looks."""
    return np.diag((1.0, 1.0, -1.0, 1.0)) @ np.linalg.inv(view.camera_to_world)
