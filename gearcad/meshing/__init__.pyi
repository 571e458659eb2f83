from .bodies import Element as Element
from .bodies import ElementMesh as ElementMesh
from .bodies import Faces as Faces
from .options import MeshOptions as MeshOptions
from .outline import MeshSizes as MeshSizes
from .sector import SectorMesh as SectorMesh
from .sector import mesh_sector as mesh_sector
