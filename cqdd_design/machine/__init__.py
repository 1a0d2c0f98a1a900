"""A design made concrete: its bought parts, solids, masses and balance."""
