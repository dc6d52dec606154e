"""Nothing the user had is lost: all or nothing, in steps, interrupted, taken back; and one sentence for errors."""
from .all_or_nothing import AllOrNothing
from .between_events import between_events, work_waits
from .gathered import gathered, listed
from .interrupts import STATUS
from .stepped_operator import BrowsingOperator, SteppedOperator
from .steps import Beside, Steps, Undivided, finished, part
from .take_back import keep_data, keep_mirror, keep_object, remove_new, still_there, unused
from .told import know_sentences, know_stages, one_or_more, tell, tell_done, translated, translated_stage
from .unforeseen import in_one_sentence, sentence

__all__ = ["AllOrNothing", "Beside", "BrowsingOperator", "STATUS", "SteppedOperator", "Steps", "Undivided",
           "between_events", "finished", "gathered", "in_one_sentence", "keep_data", "keep_mirror", "keep_object",
           "know_sentences", "know_stages", "listed", "one_or_more", "part", "remove_new", "sentence", "still_there",
           "tell", "tell_done", "translated", "translated_stage", "unused", "work_waits"]
