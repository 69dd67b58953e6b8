"""CC136 and CC137: each world of a batch has its own motion, and moves as it does alone."""

from models.errors import few
from reports.judge.rules.rule import Evidence, Finding
from reports.output.numbers import count


class OwnMotion:
    id = "CC136"
    title = "own motion of each world"
    explanation = (
        "The log of each world of a batch belongs to the start of that world: an index that is off "
        "by one gives sound motions to the wrong worlds."
    )
    cure = "Check the order of worlds where the engine is given states, and where it is read."

    def check(self, evidence: Evidence) -> Finding | None:
        """Name the worlds that are lost, or hold the motion of another."""
        batch = evidence.batch
        if batch is None:
            return None
        texts = [f"{count(batch.lost, 'world')} of {batch.count} not logged"] * bool(batch.lost)
        holds = batch.holds.items()
        pairs = (f"world {world} holds the motion of world {of}" for world, of in holds)
        texts += [few(pairs, 4)] * bool(batch.holds)
        if texts:
            return Finding(self.id, "fail", "; ".join(texts))
        return Finding(self.id, "pass", f"each of {count(batch.count, 'world')} has its own motion")


class AsAlone:
    id = "CC137"
    title = "worlds as alone"
    explanation = (
        "A world is the same run as alone: to the bit where the engine computes each world by "
        "itself, else within the rounding of its numbers."
    )
    cure = (
        "Check whether all worlds have the same model, settings and precision, and whether one "
        "ends the iterations of another."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        """Compare the largest difference with that of rounding, or with none."""
        batch = evidence.batch
        if batch is None or not batch.alone:
            return None
        of = f"{count(len(batch.alone), 'world')} of {batch.count}"
        if batch.exact:
            return Finding(self.id, "pass", f"{of}: the same to the bit as alone", 0.0)
        text = f"world {batch.at} is {batch.difference:.2g} rad or L from its run alone"
        if batch.difference == 0.0:
            text = "places are those of runs alone, but not all rates"
        within = bool(batch.why) and batch.difference <= batch.bound
        return Finding(
            self.id,
            "pass" if within else "fail",
            text + (f": {batch.why}" if batch.why else ", with which it has to agree to the bit"),
            batch.difference,
            batch.bound if batch.why else 0.0,
        )
