"""Nothing the user had is lost: all or nothing, taken back, interrupted, and one sentence for what nobody foresaw."""
from .all_or_nothing import AllOrNothing
from .interrupts import STATUS, interrupt_held
from .stepped_operator import SteppedOperator
from .take_back import keep_mesh, keep_mirror, keep_object, keep_others_mesh
from .unforeseen import in_one_sentence, sentence

__all__ = ["AllOrNothing", "STATUS", "SteppedOperator", "in_one_sentence", "interrupt_held", "keep_mesh",
           "keep_mirror", "keep_object", "keep_others_mesh", "sentence"]
