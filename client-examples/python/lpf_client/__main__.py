"""python3 -m lpf_client: the command line."""

import sys

from .command import main

sys.exit(main())
