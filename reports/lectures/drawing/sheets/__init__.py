"""Drawing sheets of the lecture, in millimetres of paper and to scale."""
