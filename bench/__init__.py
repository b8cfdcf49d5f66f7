"""Studies of photohull that take several runs of the program: python3 -m bench --help."""
