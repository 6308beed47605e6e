"""Designs of experiments over any scene: cases, factors, designs, analysis, pictures, files.

`morphing_wing.Case`, `Study`, `Factor` and `Design` are what users begin with. The ``*.toml``
beside the modules are the built-in studies.
"""
