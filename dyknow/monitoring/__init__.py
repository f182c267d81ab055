"""Formulas over the streams of a network, without a thing to be wired by hand.

A formula names features; which streams give their values is found out, the streams are made into
states, and the verdicts come out as a stream (the stream reasoning coordinator of Heintz,
'Semantically grounded stream reasoning integrated with ROS', sections VI.7 and VII). Read in this
order:

- `errors`: what can be wrong with a formula over streams
- `interpretation`: what the symbols of formulas stand for
- `grounding`: from a formula to what streams have to be found for
- `reading`: from a state to the values of features
- `unit`: the computational unit that makes verdicts out of states
- `declaring`: what has to be declared for a formula, and from when on there are states
- `evaluation`: a formula, or several, that are being evaluated
- `sharing`: streams of states that several evaluations need
- `reasoner`: adds formulas to a network that may be running, and removes them
- `plans`: the formulas of the actions of a plan, while these are executed
"""

from dyknow.monitoring.evaluation import Evaluation
from dyknow.monitoring.interpretation import Interpretation
from dyknow.monitoring.plans import PlanMonitor
from dyknow.monitoring.reasoner import EvaluationSettings, StreamReasoner
from dyknow.monitoring.unit import Decision, OnGap

__all__ = [
    "Decision",
    "Evaluation",
    "EvaluationSettings",
    "Interpretation",
    "OnGap",
    "PlanMonitor",
    "StreamReasoner",
]
