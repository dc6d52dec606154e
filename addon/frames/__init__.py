"""Frames of an animation as files: one USD file for each result and frame, and objects that play them without this
extension.

A file holds positions, faces and colours, which every Blender from 4.2 on reads back bit for bit from a sequence of
files; what else a mesh knows is packed into the colours, and nodes take it out again.
"""
from .aside import set_aside
from .by_camera import make_way, show_always, show_by_camera
from .frame_numbers import frame_numbers, frame_text
from .frame_records import (
    FrameRecord,
    ResultRecord,
    file_name,
    is_done,
    read_record,
    record_path,
    told_apart,
    write_record,
)
from .play import light_of, play, player_of, plays, results_to_play, stop_playing
from .play_caustics import play_caustics
from .sequence import Sequence
from .write_frame import write_image, write_result, writes_usd

__all__ = ["FrameRecord", "ResultRecord", "Sequence", "file_name", "frame_numbers", "frame_text", "is_done", "light_of",
           "make_way", "play", "play_caustics", "player_of", "plays", "read_record", "record_path", "results_to_play",
           "set_aside", "show_always", "show_by_camera", "stop_playing", "told_apart", "write_image", "write_record",
           "write_result", "writes_usd"]
