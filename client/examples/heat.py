#!/usr/bin/python3
"""Heat in a square or a cube, by as many ranks as there are: each reads its share of a mesh, and stores its part of each step.

    mpiexec -n 4 client/examples/heat.py MESH [STEPS [REFINED]]

Solves u' = Δu for linear finite elements, implicitly, with PETSc. The mesh is one of the unit square or the unit cube; u is 0 on its border, and
sin(πx) sin(πy) [sin(πz)] at first, so that it is known at all times: it decays by exp(-dπ²t). After REFINED steps the mesh gets points where u bends
most, and is cut anew. Rank 0 prints the greatest error of each step. Connection options come from the environment, as for psql.
"""
import math
import os
import subprocess
import sys

import numpy

from ranks import Elements, abacus_share, ask_owners, read
from mpi4py import MPI

STEP = 0.002  # time


class Problem:
    """The equations of the rank's own vertices."""

    def __init__(self, comm, share):
        self.elements = Elements(comm, share)
        border = ~((share.points > 0) & (share.points < 1)).all(axis=1)
        self.mass = self.elements.matrix(self.elements.mass, border)
        self.solver = self.elements.solver(self.elements.matrix(self.elements.mass + STEP * self.elements.stiffness, border, 1))

    def advance(self, u):
        """One step of implicit Euler."""
        return self.elements.solve(self.solver, self.elements.times(self.mass, u))


def exact(points, time):
    return numpy.prod(numpy.sin(math.pi * points), axis=1) * math.exp(-points.shape[1] * math.pi ** 2 * time)


def refine(comm, share, u):
    """Gives a twentieth of the simplices a point in the middle: those where u varies most. Returns the new share, and u on it."""
    whole = numpy.concatenate([u, ask_owners(comm, share, lambda local: u[local])])
    own = share.simplices[share.simplex_owner == share.part]
    centres, values = share.points[own].mean(axis=1), whole[own].mean(axis=1)
    range_of = numpy.ptp(whole[own], axis=1)
    bound = numpy.quantile(numpy.concatenate(comm.allgather(range_of)), 0.95)
    new = numpy.concatenate(comm.allgather(numpy.column_stack([centres, values])[range_of > bound]))
    first = max(comm.allgather(int(share.id.max()))) + 1
    if comm.rank == 0:
        axes = share.points.shape[1]
        rows = ", ".join("(" + ", ".join([str(first + n), *map(repr, map(float, row[:axes]))]) + ")" for n, row in enumerate(new))
        subprocess.run(["psql", "-X", "-q", "-v", "ON_ERROR_STOP=1", "-o", os.devnull], check=True, text=True,
                       input=f"SELECT abacus_insert({abacus_share.literal(share.mesh)}, 'VALUES {rows}');")
    comm.barrier()
    after = read(comm, share.mesh)
    # every rank knows who had which vertex, and takes the values of those that it has now
    ids = numpy.concatenate([*comm.allgather(share.id[:share.own]), numpy.arange(first, first + len(new))])
    held = numpy.concatenate([numpy.full(n, rank) for rank, n in enumerate(comm.allgather(share.own))])
    known = numpy.concatenate([*comm.allgather(u), new[:, -1]])
    order = numpy.argsort(ids)
    place = order[numpy.searchsorted(ids, after.id[:after.own], sorter=order)]
    moved = comm.allreduce(int((held[place[place < len(held)]] != comm.rank).sum()))
    if comm.rank == 0:
        print(f"refined: {len(new)} points more; {moved} of {len(held)} vertices have moved to another rank")
    return after, known[place]


def main(mesh, steps=10, refined=0):
    comm = MPI.COMM_WORLD
    share = read(comm, mesh)
    problem, u = Problem(comm, share), exact(share.points[:share.own], 0)
    for step in range(1, int(steps) + 1):
        u = problem.advance(u)
        abacus_share.store(share, step, u)
        error = comm.allreduce(float(numpy.abs(u - exact(share.points[:share.own], step * STEP)).max(initial=0)), MPI.MAX)
        if comm.rank == 0:
            print(f"step {step}: error {error:.6f}", flush=True)
        if step == int(refined):
            share, u = refine(comm, share, u)
            problem = Problem(comm, share)


if __name__ == "__main__":
    main(*sys.argv[1:])
