"""Renders the pictures of the README, of what its own commands make: `python docs/render.py` (off screen, through VTK)."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - registers the renderer
from PIL import Image
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkPolyDataNormals
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)

import gearcad
from gearcad import Body, Gear, Load, Material
from gearcad.batch import run_table
from gearcad.batch.study import plan_study, write_study
from gearcad.designs import read_spec
from gearcad.jobs.data import Data
from gearcad.per_gear import PerGear
from gearcad.planetary.speeds import speeds
from gearcad.plots import plot_contours, save_plot
from gearcad.plots.mesh import plot_body_mesh, plot_section_mesh
from gearcad.plots.planetary.front import plot_front
from gearcad.plots.planetary.scheme import plot_scheme
from gearcad.plots.sizing import save_front
from gearcad.plots.table_data import read_points
from gearcad.rating import RatingOptions
from gearcad.sizing import SizeTask, search_pairs
from gearcad.solids import tessellate
from gearcad.solids.files.options import FileOptions
from gearcad.solids.files.part import Part
from gearcad.solids.files.products import PairProduct
from gearcad.solids.files.rack_products import RackPairProduct

FOLDER = Path(__file__).parent
SPEC = FOLDER.parent / "templates" / "volvo-13-44.toml"
"""What `gearcad new volvo` writes."""

FZG_C = SPEC.with_name("fzg-c.toml")

BRASS, STEEL = (0.83, 0.62, 0.30), (0.60, 0.68, 0.76)
FEATURE_ANGLE = 25.0

Place = tuple[float, float, float]


def actors(gear: Gear, colour: tuple[float, float, float], turn: float = 0.0, x: float = 0.0, z: float = 0.0) -> list[vtkActor]:
    """A gear in its place."""
    part = Part(name="gear", facets=tessellate(gear, 0.002), colour=colour, rotation=turn, offset=(x, 0.0, z))
    return shaded(part, colour)


def shaded(part: Part, colour: tuple[float, float, float]) -> list[vtkActor]:
    """A shaded body and its sharp edges."""
    points = part.facets.vertices @ part.pose[:3, :3].T + part.pose[:3, 3]
    cells = np.ascontiguousarray(part.facets.faces, np.int64).ravel()
    mesh, places, triangles = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    triangles.SetData(3, numpy_to_vtkIdTypeArray(cells, deep=True))
    mesh.SetPoints(places)
    mesh.SetPolys(triangles)
    smooth, edges = vtkPolyDataNormals(), vtkFeatureEdges()
    smooth.SetInputData(mesh)
    smooth.SetFeatureAngle(FEATURE_ANGLE)
    edges.SetInputData(mesh)
    edges.SetFeatureAngle(FEATURE_ANGLE)
    edges.BoundaryEdgesOff()
    edges.ColoringOff()
    made = []
    for source, shade in ((smooth, colour), (edges, (0.12, 0.13, 0.15))):
        mapper, actor = vtkPolyDataMapper(), vtkActor()
        mapper.SetInputConnection(source.GetOutputPort())
        mapper.ScalarVisibilityOff()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*shade)
        made.append(actor)
    made[0].GetProperty().SetSpecular(0.35)
    made[0].GetProperty().SetSpecularPower(25)
    made[1].GetProperty().SetLineWidth(1.6)
    return made


def render(
    parts: list[vtkActor], path: Path, *, focus: Place, eye: Place, scale: float, size: tuple[int, int] = (1400, 700)
) -> None:
    """Write one picture; `eye` is the direction to look from, `scale` half the height of the view in mm."""
    renderer, window = vtkRenderer(), vtkRenderWindow()
    renderer.SetBackground(1, 1, 1)
    for part in parts:
        renderer.AddActor(part)
    for direction, strength in (((-0.6, -0.9, 1.3), 0.85), ((0.9, -0.7, 0.5), 0.55), ((0.0, 1.0, 0.4), 0.3)):
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPosition(*direction)
        light.SetIntensity(strength)
        light.PositionalOff()
        renderer.AddLight(light)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*focus)
    camera.SetPosition(*(np.array(focus) + 300 * np.array(eye) / np.linalg.norm(eye)))
    camera.SetViewUp(0, 0, 1)
    camera.SetParallelScale(scale)
    renderer.ResetCameraClippingRange()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    window.Render()
    image, writer = vtkWindowToImageFilter(), vtkPNGWriter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer.SetFileName(str(path))
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def plot_study(path: Path) -> None:
    """The study of the README."""
    varied = ["wheel.profile_shift=auto", "pinion.profile_shift=-0.2:0.6:33", "helix_angle=20:30:21"]
    with TemporaryDirectory() as folder:
        table, target = Path(folder, "study.csv"), Path(folder, "study")
        write_study(plan_study(SPEC, varied), table)
        run_table(table, target, [Data()])
        points = read_points(target / "results.csv", "pinion.profile_shift", "helix_angle", contour="usable_contact_ratio")
        save_plot(plot_contours, points, path)


def plot_elements(path: Path) -> None:
    """A section of a pair where it touches, teeth of hexahedra, and a whole part of tetrahedra."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14, 4.8), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    spur, helical = read_spec(FZG_C), read_spec(SPEC)
    pitch_point = spur.pair.working_pitch_diameters.pinion / 2
    plot_section_mesh(gearcad.mesh(spur).mesh, left, window=(pitch_point, 0, 6.5))
    plot_body_mesh(gearcad.mesh(helical, what="teeth:3", gear="pinion").mesh, middle, yaw=105, pitch=30)
    body = Body(bore=18, keyway_width=6, keyway_depth=2.8, hub_diameter=32, hub_length=8, end_chamfer=1)
    gear = Gear(teeth=24, normal_module=2.5, face_width=16, helix_angle=20, body=body)
    plot_body_mesh(gearcad.mesh(gear, what="part", size=1.6).mesh, right, yaw=20, pitch=35)
    figure.savefig(path, dpi=110)
    Image.open(path).convert("RGB").quantize(48).save(path, optimize=True)


def render_kinds(path: Path) -> None:
    """A pinion in its ring, one on a rack, and double helical gears: the starters, side by side."""
    fine = FileOptions(chord_error=0.004)
    views = {
        "ring-22-70": (PairProduct, ((-66, 0, 0), (0.35, -0.8, 1.3), 122)),
        "rack": (RackPairProduct, ((12, 0, 12), (-1.1, -0.35, 0.9), 62)),
        "double-23-81": (PairProduct, ((165, 0, 75), (-0.25, -1.0, 0.75), 235)),
    }
    pictures = []
    with TemporaryDirectory() as folder:
        for name, (product, (focus, eye, scale)) in views.items():
            scene = product(read_spec(SPEC.with_name(f"{name}.toml")).assembly, fine).scene()
            parts = [actor for part, colour in zip(scene, (BRASS, STEEL), strict=True) for actor in shaded(part, colour)]
            target = Path(folder, f"{name}.png")
            render(parts, target, focus=focus, eye=eye, scale=scale, size=(640, 560))
            pictures.append(np.array(Image.open(target).convert("RGB")))
    Image.fromarray(np.hstack(pictures)).quantize(96).save(path, optimize=True)


def plot_train(path: Path) -> None:
    """The train of the Alm thesis: its scheme, and both rings with the planets in mesh."""
    from matplotlib.figure import Figure

    train = read_spec(SPEC.with_name("planetary-alm.toml")).train
    figure = Figure(figsize=(14, 4.5), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=(1, 1.35))
    plot_scheme(train, left.subplots())
    turning = speeds(train, {train.input: 1.0})
    plot_front(train, train.pose(), {**turning.members, "planet": turning.planet}, right)
    figure.savefig(path, dpi=110)
    Image.open(path).convert("RGB").quantize(64).save(path, optimize=True)


def plot_sizes(path: Path) -> None:
    """The pairs of the task in the README."""
    materials = PerGear(Material(name="Eh MQ"), Material(name="Eh MQ"))
    task = SizeTask(load=Load(torque=302, speed=1500), ratio=1.5, materials=materials, rating=RatingOptions(life=20000))
    save_front(search_pairs(task, errors=0), path)
    Image.open(path).convert("RGB").quantize(32).save(path, optimize=True)


def main() -> None:
    pair = read_spec(SPEC).pair
    assert pair is not None  # the starter is one
    pose = pair.wheel_pose()
    pinion, wheel = actors(pair.pinion, BRASS), actors(pair.wheel, STEEL, pose.rotation, pose.x, pose.z)
    render(pinion + wheel, FOLDER / "pair.png", focus=(62, 0, 6), eye=(-0.3, -1.0, 0.75), scale=50)
    render(pinion + wheel, FOLDER / "mesh.png", focus=(19, 0, 18), eye=(0.0, -0.05, 1.0), scale=9)
    plot_study(FOLDER / "study.png")
    plot_elements(FOLDER / "elements.png")
    render_kinds(FOLDER / "kinds.png")
    plot_train(FOLDER / "train.png")
    plot_sizes(FOLDER / "size.png")


if __name__ == "__main__":
    main()
