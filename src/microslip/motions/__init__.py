"""Motions: one file each, which holds SCENE, a scene.Scene; ``scenes`` finds them by their names.

A family of motions holds instead: DEFAULTS, the numbers that may follow its name and their values
if they are not given; scene(name, **numbers) -> Scene, which raises ValueError for numbers out of
range; HELP, what the numbers are, for the command line; and SUMMARY, as of a Scene.
"""
