"""What pictures of objects' light are divided into: triangles, their parts, and the texels that they own."""
from .atlas import Atlas, arranged, packed
from .division import Division, divided, enlarged, parts_along
from .whole_texels import UNTOUCHED, framed, has_pattern, is_glossy, mean_of_what_is_known

__all__ = ["Atlas", "Division", "UNTOUCHED", "arranged", "divided", "enlarged", "has_pattern", "is_glossy",
           "mean_of_what_is_known", "framed", "packed", "parts_along"]
