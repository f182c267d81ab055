"""Metric temporal logic over streams of states: the language, its meaning, and progression.

Read in this order: `syntax`, `grammar.lark`, `parser`, `printer`, `check`, `quantifiers`,
`declarations`, `symbols`, `semantics`, `truth`, `columns`, `instants`, `nodes`, `entailment`,
`graph`, `knowledge`, `domination`, `residuals`, `moments`, `decisions`, `rules`, `wording`,
`progression`, `products`, `monitors`, `groups`, `operators`, `execution`.
"""

from dyknow.mtl.columns import evaluate_atoms
from dyknow.mtl.groups import FormulaGroup
from dyknow.mtl.monitors import Monitor, MonitorColumns
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.progression import ProgressionTable
from dyknow.mtl.syntax import Formula, TimeModel, Verdict

__all__ = [
    "Formula",
    "FormulaGroup",
    "Monitor",
    "MonitorColumns",
    "ProgressionTable",
    "TimeModel",
    "Verdict",
    "evaluate_atoms",
    "parse_formula",
    "text_from_formula",
]
