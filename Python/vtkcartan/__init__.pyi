from .arrays import Deformer as Deformer, Measures as Measures, deform as deform, measure as measure, morph as morph
from .landmarks import read_landmarks as read_landmarks
from .vtkCartan import *
