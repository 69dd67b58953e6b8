"""Advice as JSON: the facts of the table, with all digits, every setting and the snippets."""

from __future__ import annotations

import json
from collections.abc import Mapping

from reports.advise.advice import Advice, Offer
from reports.advise.demand import Demand
from reports.advise.search import Worst
from reports.advise.table import word
from reports.output.numbers import finite
from sim.registry import engine


def document(advice: Advice) -> str:
    """The text of the file; what is not finite is null."""
    demand, known = advice.demand, advice.known
    content = {
        "provenance": dict(advice.facts),
        "asked": {
            "scenes": [scene.name for scene in demand.scenes],
            "speed_rad_s": demand.speed_rad_s,
            "frame_s": demand.frame_s,
            "frames_per_turn": demand.frames_per_turn,
            "turns": demand.turns,
            "target": demand.target,
            "most_substeps": demand.most,
        },
        "study": None
        if known.folder is None
        else {
            "folder": str(known.folder),
            "turns": known.turns,
            "lines": len(known.measured),
            "not_used": list(known.refusals),
        },
        "noise": advice.noise,
        "best": [offer.reached.choice.label for offer in advice.best],
        "settings": [_offer(advice, offer) for offer in advice.offers],
    }
    return json.dumps(finite(content), indent=1) + "\n"


def _offer(advice: Advice, offer: Offer) -> Mapping[str, object]:
    """One choice."""
    reached, demand = offer.reached, advice.demand
    choice, price = reached.choice, offer.price
    return {
        "engine": choice.engine,
        "version": engine(choice.engine).version(),
        "name": choice.name,
        "profile": choice.profile,
        "settings": dict(choice.settings),
        "at_frame": {"word": word(reached.at_frame, demand.target)}
        | _worst(demand, reached.at_frame),
        "promise": reached.promise
        and _worst(demand, reached.promise) | {"held_at": list(reached.held_at)},
        "unsteady": list(reached.unsteady),
        "nearest": reached.nearest and _worst(demand, reached.nearest),
        "ended": reached.ended and {"status": reached.ended.status, "reason": reached.ended.reason},
        "runs": reached.runs,
        "us_per_step": price and price.us_per_step,
        "ms_per_simulated_s": price and 1e3 * price.s_per_s,
        "of_real_time": price and price.s_per_s,
        "dearest_scene": price and price.scene,
        "times_cheapest": price and offer.s_per_s / advice.promises[0].s_per_s,
        "snippet": advice.snippet(offer),
    }


def _worst(demand: Demand, worst: Worst | None) -> dict[str, object]:
    """The numbers of some sub-steps; none where they were not run."""
    if worst is None:
        return {}
    return {
        "substeps": worst.substeps,
        "dt_s": demand.frame_s / worst.substeps,
        "steps_per_turn": demand.steps_per_turn(worst.substeps),
        "place_error": worst.error,
        "scene": worst.scene,
        "status": worst.seen.status,
        "growth": worst.seen.growth,
        "measured": "study" if worst.seen.studied else "now",
    }
