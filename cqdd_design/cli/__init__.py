"""The command line: one module a command, nothing but parsing, one library call, printing."""
