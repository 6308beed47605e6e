"""Frames by the direct stiffness method: members with Timoshenko's exact stiffness, numpy only."""

import numpy as np


def exact_compliance(frame, material):
    """Motion of the tail (u in mm, theta) under its six unit loads, root clamped, small motions."""
    K = np.zeros((6 * len(frame.points),) * 2)
    stiffness = frame.stiffness(material.E, material.nu)
    for (a, b), axes, values, length in zip(
            frame.bars, frame.axes, stiffness, frame.lengths(), strict=True):
        turn = np.kron(np.eye(4), axes)
        at = np.r_[6 * a:6 * a + 6, 6 * b:6 * b + 6]
        K[np.ix_(at, at)] += turn.T @ member(values, length) @ turn
    free = np.setdiff1d(np.arange(len(K)), 6 * frame.roots[0] + np.arange(6))
    tail = np.searchsorted(free, 6 * frame.tails[0] + np.arange(6))
    loads = np.zeros((len(free), 6))
    loads[tail, np.arange(6)] = 1.0
    return np.linalg.solve(K[np.ix_(free, free)], loads)[tail]


def member(values, L):
    """Stiffness of a bar in its own axes: from the exact flexibility of a cantilever."""
    EA, GA2, GA3, GJ, EI2, EI3 = values
    F = np.diag([L / EA, L**3 / (3 * EI3) + L / GA2, L**3 / (3 * EI2) + L / GA3,
                 L / GJ, L / EI2, L / EI3])
    F[1, 5] = F[5, 1] = L**2 / (2 * EI3)
    F[2, 4] = F[4, 2] = -(L**2) / (2 * EI2)
    # Forces at the first end hold those at the second in balance.
    balance = -np.eye(6)
    balance[4, 2], balance[5, 1] = L, -L
    both = np.vstack([balance, np.eye(6)])
    return both @ np.linalg.inv(F) @ both.T
