"""The compound planetary gear the paper compares with: kinematics, assembly, ISO 6336 rating.

Modules, in reading order: `kinematics`, `assembly`, `tooth_geometry` (ISO 21771), `profile_shift`,
`gear_material` (ISO 6336-5), `iso6336` (parts 1 to 3), `settings` (what the designer chooses),
`load_factors` and `rating` (one mesh at one load), `gear_set` (any number of planets), `claims` and
`claim_settings` (the paper's sentences, answered), `compare` (everything in one call).
"""
