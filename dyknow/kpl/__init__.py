"""KPL, the language in which a network of knowledge processes is declared.

Read in this order:

- `syntax`: the classes of the syntax tree; `grammar.lark`: how it is written
- `parser` and `printer`: from text to tree and back; `recovery`, `wording`: what is said about
  texts that do not follow the grammar; `build`: trees made in Python
- `names`: what a specification declares, and what a label means; `parameters`: values and members
  in the places of names
- `policies`: from constraints to a `Policy`; `states`: to the unit of a synchronisation;
  `settings`: what units are made with
- `sorts`, `promises`, `cycles`, `duplicates`: what can be wrong; `check`: every static fault
- `unused`: what output streams need, and declarations that nothing needs
- `implementations`: what symbols stand for; `members`: the members of sets, and mediation
- `assembly`: processes in and out of a kernel; `outputs`: the output streams; `configuration`:
  what changes by itself
- `network`: a network that can be changed while it runs; `removing`, `replacing`: what that means
  for its specification; `description`, `describing`: what it is made of, as plain data
- `plan`: from a specification to a network that runs
"""
