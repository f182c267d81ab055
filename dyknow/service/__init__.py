"""The middleware service: knowledge processes made, managed, queried and governed at run time.

The names are those of Heintz (2009), chapter 5. Read in this order:

- `prototypes`: what knowledge processes are made of
- `factory`: makes and destroys them
- `manager`: which stream generator a label stands for
- `governor`: which streams stand back when the network falls behind
- `application`: all of it, on top of KPL declarations that come and go
"""
