#!/usr/bin/env python3
"""Denoises, resamples and analyses 3D scans with a Local Probing Fields server.

    lpf_client.py denoise in.ply -o out.ply --radius auto
    lpf_client.py --help

Needs Python 3.9 or newer and nothing else. The work is done by the package lpf_client beside this
file, which programs import as well.
"""

import sys

from lpf_client.command import main  # the package: Python prefers it to this file of the same name

if __name__ == "__main__":
    sys.exit(main())
