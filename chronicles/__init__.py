"""Complex events recognised from simple ones.

Read in this order:

- `syntax`: what a chronicle says; `parser` and `printer`: text to chronicle and back;
  `parameters`: values that may be replaced; `recovery`, `wording`, `intervals` and
  `arrangements`: what the parser needs; `spacing`: what the printer needs
- `constraints`: simple temporal networks; `conditions`: on values; `expansion`: what is named or
  included, put in; `timing`: when instants can be
- `declared`: what a file declares; `naming`, `circles`, `event_types`, `uses`, `bindings`: what
  can be wrong; `check`: every fault of a file; `comments`: what is said about a chronicle
- `events`: what goes in and comes out; `acceptance`: which events are as declared; `semantics`:
  what chronicles mean
- `patterns` and `models`: chronicles prepared for recognition; `boundedness`: what may be awaited
  without end; `unused`: what nothing uses
- `instances`: partial instances and how they are found; `counting`; `matching`: which instances
  begin, go on, complete, or die; `joining`: how an event joins them; `writing`: the functions
  that do so, written out for each chronicle; `routing`: which chronicles an event concerns;
  `reporting`: which matches are reported; `prospects`: partial instances as people see them
- `recognition`: the recogniser; `ordering`: samples in the order of their valid times;
  `processes`: the recogniser on streams; `recognised`: what it recognises as events for others;
  `marking`: the objects that it was about; `specified`: files that a specification names
- `attributes`: which streams the attributes of chronicles stand for; `observing`: changes of
  their values as events; `registering`: what is declared for a chronicle; `reasoning`: chronicles
  over the streams of a network
- `errors`
"""

from chronicles.events import Event, Recognition
from chronicles.models import Model, models_from_chronicles
from chronicles.parser import parse_chronicles, read_chronicles
from chronicles.recognition import Recogniser

__all__ = [
    "Event",
    "Model",
    "Recogniser",
    "Recognition",
    "models_from_chronicles",
    "parse_chronicles",
    "read_chronicles",
]
