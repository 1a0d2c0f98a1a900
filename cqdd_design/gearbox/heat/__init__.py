"""Heat in the gearbox: how parts expand, how it gets from part to part, and how warm they get."""
