"""Hard cases of elastic links, by the group of the catalogue."""

from reports.stability.catalogue import elastic_links

CASES = {"elastic links": elastic_links.CASES}
