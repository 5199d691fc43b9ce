"""The rounding of one operation in double precision."""

import numpy as np

#: distance from 1 to the next number (Higham, "Accuracy and Stability of Numerical Algorithms", 2002, section 2.1)
EPS = float(np.finfo(float).eps)
