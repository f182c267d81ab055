"""KPL, the language in which a network of knowledge processes is declared.

Read in this order:

- `syntax`: the classes of the syntax tree; `grammar.lark`: how it is written
- `parser` and `printer`: from text to tree and back; `build`: trees made in Python
- `names`: what a specification declares; `parameters`: values that the caller may choose
- `policies`: from constraints to a `Policy`; `settings`: what units are made with
- `check`: every static fault; `unused`: declarations that nothing needs
- `plan`: from a specification to a network that runs
"""
