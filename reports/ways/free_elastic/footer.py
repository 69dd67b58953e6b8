"""What stands under the tables of free cells of elastic links."""

from reports.ways.elastic.footer import BENT_WORDS
from reports.ways.free.footer import STEPPED

FOOTER = (BENT_WORDS, STEPPED)
