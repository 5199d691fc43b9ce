"""The rounding of one operation in double precision, and how large numbers may be."""

import numpy as np

#: distance from 1 to the next number (Higham, "Accuracy and Stability of Numerical Algorithms", 2002, section 2.1)
EPS = float(np.finfo(float).eps)
#: its square is a number, too: it stands for what is larger than anything
LARGEST = 1e150
