"""The sound of a study: read back by the standard library, its frequencies those of teeth and torques, the same bytes again."""

import json
import wave
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from gearcad.cli import main
from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats
from gearcad.designs import read_spec
from gearcad.dynamics import DynamicsOptions, Inertia, Shaft, ToothMesh, TorqueExcitation, Train
from gearcad.dynamics.sound import RATE, sound_of
from gearcad.dynamics.time_domain.transient_result import TransientOptions
from gearcad.dynamics.train_study import study_modes, study_torques, study_train
from gearcad.jobs.dynamics import Dynamics

QUICK = DynamicsOptions(speeds=5, speed_from=1100.0, speed_to=1300.0)

SPEC = """
[train]
name = "hum"
model = "massless"
speed = 1200.0
[train.torques]
p = 100.0
w = 200.0
[[train.inertia]]
name = "p"
inertia = 0.004
[[train.inertia]]
name = "w"
inertia = 0.03
[[train.mesh]]
name = "z"
pinion = "p"
wheel = "w"
base_radii = [40.0, 80.0]
stiffness = 300.0
teeth = 20
damping_ratio = 0.05
variation = 0.2
[dynamics]
speeds = 5
speed_from = 1100.0
speed_to = 1300.0
"""


def pair(*excitations: TorqueExcitation) -> Train:
    mesh = ToothMesh(
        name="z", pinion="p", wheel="w", base_radii=(40.0, 80.0), stiffness=300.0, teeth=20, damping_ratio=0.05, variation=0.2
    )
    inertias = (Inertia(name="p", inertia=0.004), Inertia(name="w", inertia=0.03))
    return Train(
        inertias=inertias, meshes=(mesh,), torques={"p": 100.0, "w": 200.0}, speed=1200.0, excitations=excitations
    )  # fmt: skip


def read_back(path: Path) -> Floats:
    with wave.open(str(path), "rb") as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, RATE)
        return np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(float)


def amplitude(samples: Floats, hertz: float) -> float:
    """Amplitude of one frequency by Hann's window, on its own."""
    time = np.arange(len(samples)) / RATE
    window = np.hanning(len(samples))
    return float(2 * abs((samples * window * np.exp(-2j * np.pi * hertz * time)).sum()) / window.sum())


def test_the_sound_of_one_speed_has_the_lines_of_teeth_and_torque(tmp_path: Path) -> None:
    """400 Hz of 20 teeth at 1200 rpm and its double, 60 Hz of the third order: each as high as in the force of the course."""
    study = study_train(pair(TorqueExcitation(name="e", inertia="w", order=6.0, amplitude=20.0)), QUICK)
    sound = sound_of(study)
    sound.write(tmp_path / "a.wav")
    samples = read_back(tmp_path / "a.wav")
    assert len(samples) == 3 * RATE and np.abs(samples).max() == pytest.approx(0.9 * 32767, abs=1)
    force = study.course.force[:, 0]
    lines = 2 * np.abs(np.fft.rfft(force, norm="forward"))
    each = study.excitation.period  # teeth in the common period
    for hertz in (60.0, 400.0, 800.0):
        expected = lines[round(hertz / 400.0 * each)] / sound.greatest * 0.9 * 32767
        assert amplitude(samples, hertz) == pytest.approx(expected, rel=0.01, abs=1)
    assert amplitude(samples, 0.0) < 1.0
    assert sound.signal == "forces between the flanks of z, steady motion at 1200 rpm, from 20 to 20000 Hz"


def chain() -> Train:
    """Two inertias and a shaft, shaken at twice the speed."""
    return Train(
        inertias=(Inertia(name="a", inertia=0.1), Inertia(name="b", inertia=0.3)),
        shafts=(Shaft(name="s", start="a", end="b", torsional_stiffness=2e4, damping=3.0),),
        excitations=(TorqueExcitation(name="e", inertia="a", order=2.0, amplitude=10.0),),
    )


def test_the_sound_of_a_run_follows_the_speed(tmp_path: Path) -> None:
    """From 900 to 2700 rpm in 3 s: in each fifth of a second the highest line is the second order. Shafts are heard."""
    transient = TransientOptions(speed_from=900.0, speed_to=2700.0, duration=3.0, sampling=4000.0)
    sound = sound_of(study_torques(chain(), DynamicsOptions(speeds=5, transient=transient)))
    assert (sound.unit, sound.signal) == ("N·m", "torques of the shafts of s, run in time, from 20 to 20000 Hz")
    sound.write(tmp_path / "run.wav")
    samples = read_back(tmp_path / "run.wav")
    assert len(samples) == pytest.approx(3 * RATE, abs=20)
    for middle in (0.3, 1.0, 2.5):
        part = samples[int((middle - 0.1) * RATE) : int((middle + 0.1) * RATE)]
        hertz = np.fft.rfftfreq(len(part), 1 / RATE)
        found = float(hertz[np.abs(np.fft.rfft(part * np.hanning(len(part)))).argmax()])
        assert found == pytest.approx(2 * (900 + 600 * middle) / 60, abs=5.0)


def test_a_steady_run_is_as_loud_as_its_greatest_value() -> None:
    transient = TransientOptions(speed_from=1500.0, duration=1.0, sampling=2000.0)
    sound = sound_of(study_torques(chain(), DynamicsOptions(speeds=5, transient=transient)))
    assert amplitude(sound.samples.astype(float), 50.0) == pytest.approx(0.9 * 32767, rel=0.05)


def test_what_has_neither_run_nor_teeth_is_not_heard() -> None:
    with pytest.raises(ParameterError, match="needs a run in time"):
        sound_of(study_modes(chain()))


@pytest.mark.long
def test_the_command_writes_the_file_and_says_what_it_is(tmp_path: Path) -> None:
    """The same bytes as from Python."""
    spec = tmp_path / "hum.toml"
    spec.write_text(SPEC, encoding="utf-8")
    result = CliRunner().invoke(main, ["dynamics", str(spec), "--wav", "-o", str(tmp_path / "a")])
    assert result.exit_code == 0, result.output
    assert "sound: forces between the flanks of z, steady motion at 1200 rpm" in result.output
    again = Dynamics(wav=True).run(read_spec(spec))
    sound_of(again).write(tmp_path / "again.wav")
    assert (tmp_path / "a" / "dynamics.wav").read_bytes() == (tmp_path / "again.wav").read_bytes()
    told = json.loads((tmp_path / "a" / "dynamics.json").read_text(encoding="utf-8"))["sound"]
    assert told == sound_of(again).to_dict()
