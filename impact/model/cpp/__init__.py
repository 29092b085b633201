"""The resolver of C++: what a name, a type or a member stands for, across the files of a package and beyond it."""
