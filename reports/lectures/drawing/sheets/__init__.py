"""Drawing sheets: what the lecture draws, in millimetres of paper and to scale."""
