r"""Eq. 1 to 16 as the paper prints them, in its own symbols; nothing is corrected here.

Indices: i a level (1 is the largest, M the number of levels), j a strip (N in half a cell, each :math:`\Delta` wide).
"""

PRINTED = {
    1: r"w + T_\varepsilon \frac{\partial w}{\partial t} = \frac{1}{K}\left( p + T_\sigma \frac{\partial p}{\partial t} \right)",
    2: r"p_a(\delta) = \begin{cases} p_0, & 0 < \delta \leq \delta_0, \\ 0, & \delta > \delta_0 \end{cases}",
    3: r"\gamma = \int_0^{+\infty} p_a(\delta)\, d\delta = p_0 \delta_0",
    4: r"f_i(x, y) = h_i - \frac{h_i}{4}\left(\cos\left(\frac{2\pi x}{l_i}\right) + 1\right)"
    r"\left(\cos\left(\frac{2\pi y}{l_i}\right) + 1\right)",
    5: r"w_i - V T_\epsilon \frac{\partial w_i}{\partial x} = "
    r"\frac{1}{K}\left( p_i - T_\sigma V \frac{\partial p_i}{\partial x} \right)",
    6: r"\begin{aligned} w_i(x,y) &= f_i(x,y) + D_i, & (x,y) \in \Omega_i^c \\ p_i(x,y) &= -p_0, & (x,y) \in \Omega_i^a \\ "
    r"p_i(x,y) &= 0, & (x,y) \notin \Omega_i^c \cup \Omega_i^a \end{aligned}",
    7: r"\bar{p}_i = \frac{1}{l_i^2} \iint_{\Omega_i} p_i(x, y)\, dx\, dy",
    8: r"D_i^j = \frac{h_i}{2}\left(\cos\left(\frac{2\pi y_j}{l_i}\right) - 1\right) + D_i",
    9: r"A_i = 2\Delta \sum_{j=1}^N (a_i^j + b_i^j)",
    10: r"\tau_i(x, y_j) = p_i(x, y_j) \frac{\partial f_i(x, y_j)}{\partial x}",
    11: r"\bar{p}_i = \frac{2\Delta}{l_i^2} \sum_{j=1}^N \int_{-l_i/2}^{l_i/2} p_i(x, y_j)\, dx, \quad "
    r"\bar{\tau}_i = \frac{2\Delta}{l_i^2} \sum_{j=1}^N \int_{-l_i/2}^{l_i/2} \tau_i(x, y_j)\, dx",
    12: r"\tau_{M-1} = p_{M-1}(x, y_j) \frac{\partial}{\partial x} f_{M-1}(x, y_j) + \bar{\tau}_M[p_{M-1}(x, y_j)]",
    13: r"\bar{\tau}_{M-1} = \frac{2\Delta}{l_{M-1}^2} \sum_{j=1}^N \int_{-l_{M-1}/2}^{l_{M-1}/2} p_{M-1}(x, y_j) "
    r"\frac{\partial}{\partial x} f_{M-1}(x, y_j)\, dx + \frac{2\Delta}{l_{M-1}^2} \sum_{j=1}^N "
    r"\int_{-l_{M-1}/2}^{l_{M-1}/2} \bar{\tau}_M[p_{M-1}(x, y_j)]\, dx",
    14: r"\mu = \frac{\bar{\tau}_1}{\bar{p}_1} = \frac{2\Delta}{\bar{p}_1 l_1^2} \sum_{j=1}^N \int_{-l_1/2}^{l_1/2} p_1(x, y_j) "
    r"\frac{\partial}{\partial x} f_1(x, y_j)\, dx + \frac{2\Delta}{\bar{p}_1 l_1^2} \sum_{j=1}^N \int_{-l_1/2}^{l_1/2} "
    r"\bar{\tau}_2[p_1(x, y_j)]\, dx",
    15: r"\begin{aligned} p_i(x, y_j) &= \frac{K}{2(l_i^2 + 4\pi^2 T_\sigma^2 V^2)} \left[ "
    r"\frac{h_i}{2}\left(\cos\frac{2\pi y_j}{l_i} + 1\right) \right. \\ "
    r"&\times \left\{ (l_i^2 + 4\pi^2 T_\varepsilon T_\sigma V^2)\cos\frac{2\pi x}{l_i} "
    r"+ 2\pi l_i V (T_\varepsilon - T_\sigma)\sin\frac{2\pi x}{l_i} \right\} \\ "
    r"&\left. + (4\pi^2 T_\sigma^2 V^2 + l_i^2)\left\{ \frac{h_i}{2}\left(\cos\frac{2\pi y_j}{l_i} - 3\right) + 2D \right\} "
    r"\right] \end{aligned}",
    16: r"\mu = \frac{\pi^2 K V (T_\varepsilon - T_\sigma)}{\bar{p}_1} \sum_{i=1}^N \frac{h_i}{4\pi^2 V^2 T_\sigma^2 + l_i^2}",
}  # fmt: skip

SUBJECTS = {
    1: "law of the foundation",
    2: "traction of adhesion",
    3: "specific energy of adhesion",
    4: "shape of a level",
    5: "law in the frame of the surface",
    6: "conditions in contact, in adhesion, and outside both",
    7: "equilibrium: the load of a level",
    8: "penetration of a strip",
    9: "contact area of a level",
    10: "stress at a point of a strip",
    11: "means of a level, as sums over its strips",
    12: "stress of a level that carries another",
    13: "mean of that stress",
    14: "friction coefficient",
    15: "pressure of complete contact",
    16: "friction coefficient in complete contact on all levels",
}
