"""What stands under the tables of free cells of elastic links, which are those of elastic ones."""

from reports.ways.elastic.table import BENT_WORDS
from reports.ways.free.table import STEPPED

FOOTER = (BENT_WORDS, STEPPED)
