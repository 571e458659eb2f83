"""Power flow through a model of REXS: speed and torque of each shaft, from those that loads and shafts define."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.exchange.rexs_model import RexsModel


class ModelPower:
    """Speeds (rpm) and torques (N·m) of the shafts and stages of a model, as far as they follow.

    Speeds follow from stage to stage by numbers of teeth. The torque of a stage on a shaft follows where all others on it are
    known: the sum of loads and stages is 0. Models with planetary stages have other rules: nothing follows there.
    """

    def __init__(self, model: RexsModel) -> None:
        self.model, self.told = model, list[str]()
        self.speeds: dict[int, float] = {}
        self.torques: dict[tuple[int, int], float] = {}
        self.stages: list[tuple[int, tuple[int, int]]] = []
        self.shafts = {
            gear.number: relation.roles["assembly"]
            for gear in model.of_kind("cylindrical_gear", "ring_gear")
            for relation in model.related("assembly", "part", gear.number)
            if "assembly" in relation.roles and model.components[relation.roles["assembly"]].kind == "shaft"
        }
        if model.of_kind("planetary_stage"):
            self.told.append("loads: the power flow of planetary stages is not followed; give the load of each pair yourself")
            return
        self.stages = list(self._stages())
        self._follow_speeds()
        self._follow_torques()

    def _stages(self) -> Iterator[tuple[int, tuple[int, int]]]:
        """Yield each stage with its two gears, both of which are on shafts."""
        for stage in self.model.of_kind("cylindrical_stage"):
            for relation in self.model.related("stage", "stage", stage.number):
                gears = [relation.roles.get(name) for name in ("gear_1", "gear_2")]
                first, second = gears
                if first in self.shafts and second in self.shafts and first is not None and second is not None:
                    yield stage.number, (first, second)

    def _signed_teeth(self, number: int) -> int:
        """Return the number of teeth of a gear, negative of a ring; 0 where there is none."""
        gear = self.model.components[number]
        return (gear.whole("number_of_teeth") or 0) * (-1 if gear.kind == "ring_gear" else 1)

    def _ratio(self, gear: int, mate: int) -> float | None:
        """Return the number of teeth of the mate over that of a gear, signed."""
        own, other = self._signed_teeth(gear), self._signed_teeth(mate)
        return other / own if own and other else None

    def _follow_speeds(self) -> None:
        for shaft in self.model.of_kind("shaft"):
            speed = shaft.float_of("rotational_speed")
            if speed is not None:
                self.speeds[shaft.number] = speed
        for _ in self.stages:
            for _, (first, second) in self.stages:
                for gear, mate in ((first, second), (second, first)):
                    ratio = self._ratio(gear, mate)
                    if self.shafts[gear] in self.speeds and ratio is not None:
                        self.speeds.setdefault(self.shafts[mate], -self.speeds[self.shafts[gear]] / ratio)

    def _loads(self, shaft: int) -> tuple[float | None, bool]:
        """Return the sum of torques of a shaft's loads, None without one, and whether one is not known."""
        known, unknown = list[float](), False
        for load in self.model.parts(shaft, "external_load"):
            torque = load.float_of("torque_around_u_axis")
            if torque is None and load.flag("transmits_torque"):
                power, speed = load.float_of("power"), self.speeds.get(shaft)
                unknown = unknown or power is None or not speed
                if power is not None and speed:
                    known.append(9549.296585513721 * power / speed)
            elif torque is not None and load.flag("transmits_torque") is not False:
                known.append(torque)
        return (sum(known) if known else None), unknown

    def _follow_torques(self) -> None:
        """Find the torques that the teeth of each stage put on both of its shafts."""
        on_shafts: dict[int, list[tuple[int, tuple[int, int]]]] = {}
        for stage, gears in self.stages:
            for shaft in dict.fromkeys(self.shafts[each] for each in gears):
                on_shafts.setdefault(shaft, []).append((stage, gears))
        loads = {shaft: self._loads(shaft) for shaft in on_shafts}
        for _ in range(len(self.stages) + 1):
            for shaft, (given, unknown) in loads.items():
                open_ones = [each for each in on_shafts[shaft] if (each[0], shaft) not in self.torques]
                sum_known = (given or 0.0) + sum(self.torques.get((stage, shaft), 0.0) for stage, _ in on_shafts[shaft])
                if unknown or len(open_ones) != 1 or (given is None and len(on_shafts[shaft]) < 2):
                    continue
                stage, gears = open_ones[0]
                here, there = gears if self.shafts[gears[0]] == shaft else gears[::-1]
                ratio = self._ratio(here, there)
                if ratio is not None:
                    self.torques[stage, shaft] = 0.0 - sum_known
                    self.torques[stage, self.shafts[there]] = (0.0 - sum_known) * ratio

    def of_stage(self, stage: int, pinion: int) -> tuple[float | None, float | None]:
        """Return the torque on the pinion of a stage, against that of its teeth, and its speed; None if unknown."""
        shaft = self.shafts.get(pinion)
        if shaft is None:
            return None, None
        torque = self.torques.get((stage, shaft))
        return (0.0 - torque if torque else None), self.speeds.get(shaft)
