from .arrays import Deformer as Deformer, Measures as Measures, deform as deform, measure as measure, morph as morph
from .vtkCartan import *
