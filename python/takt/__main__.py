"""python -m takt"""

import sys

from takt.cli import main

sys.exit(main())
