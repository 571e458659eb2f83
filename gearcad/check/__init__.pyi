from .options import CheckOptions as CheckOptions
from .options import Model as Model
from .result import CheckResult as CheckResult
from .result import PlaneCheck as PlaneCheck
from .result import SolidCheck as SolidCheck
from .run import check_pair as check_pair
from .task import CheckTask as CheckTask
from .task import check_task as check_task
