import os

from vtkmodules.vtkCommonDataModel import vtkTable

def read_landmarks(file_name: str | os.PathLike[str], system: str = "LPS") -> vtkTable: ...
