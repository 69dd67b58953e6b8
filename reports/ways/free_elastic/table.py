"""The footer of free cells of elastic links; their table is that of elastic cells."""

from reports.ways.elastic.table import BENT_WORDS
from reports.ways.free.table import STEPPED

FOOTER = (BENT_WORDS, STEPPED)
