"""Maps by which a picture looks right in a mirror alone: sheets cut along what it shows of them, and their prints.

In come the pieces of the scene that a mirror shows (`core.picture_pieces`); out come copies of the objects, or maps on
them, the paper with the picture, and files to print.
"""
from .copies import shown, source_of, write_copy
from .cut_triangles import Parts, cut_triangles
from .flat_sheet import FlatSheet, flat_sheet, why_no_sheet
from .frame import Frame
from .own_map import OwnMap, own_map, write_own_map
from .paper import load_picture, paper_with, picture_of
from .printing import encoded, pixels_of, print_size, printed
from .sheet_arrays import SEEN, UV_MAP, Sheet, sheet

__all__ = ["FlatSheet", "Frame", "OwnMap", "Parts", "SEEN", "Sheet", "UV_MAP", "cut_triangles", "encoded", "flat_sheet",
           "load_picture", "own_map", "paper_with", "picture_of", "pixels_of", "print_size", "printed", "sheet",
           "shown", "source_of", "why_no_sheet", "write_copy", "write_own_map"]
