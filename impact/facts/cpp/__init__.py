"""C++: what every check reads of a file (lexical.py), and its syntax where somebody asks: for names and types in use
(code.py), and for the flow of messages (flow.py). What a header offers is read by databuild/extract."""
