"""What the bill of materials says beside names and masses: fitting, substitutes, prices."""
