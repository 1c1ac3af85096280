#!/usr/bin/python3
"""Waves in a mesh in space or in the plane, by as many ranks as there are: each reads its share, and stores its part of each step.

    mpiexec -n 4 client/examples/waves.py MESH STEPS TIME X,Y[,Z],WIDTH     a pulse of this width that starts there, of height 1
    mpiexec -n 4 client/examples/waves.py MESH STEPS TIME standing          a wave in the unit square or cube that is known at all times

Solves ρ u'' = div(ρ v² grad u) for linear finite elements with steps of this time; the border is free. v and ρ are the attributes vs and density of
the mesh, or 1 without them. The steps are Newmark's with constant acceleration, which conserve energy; PETSc solves the equations of each.
A step has u and u'. Rank 0 prints the energy. Connection options come from the environment, as for psql.
"""
import math
import sys

import numpy

from ranks import Elements, abacus_share, read
from mpi4py import MPI


def standing(points, time):
    return numpy.prod(numpy.cos(math.pi * points), axis=1) * math.cos(math.pi * math.sqrt(points.shape[1]) * time)


def pulse(points, place):
    *centre, width = map(float, place.split(","))
    return numpy.exp(-((points - centre) ** 2).sum(axis=1) / (2 * width ** 2))


class Waves:
    def __init__(self, comm, share, time):
        self.comm, self.time, self.elements = comm, time, Elements(comm, share)
        speed, density = (share.attribute(name) if name in share.names else numpy.ones(len(share.id)) for name in ("vs", "density"))
        of_mass = self.elements.mean(density) * self.elements.mass
        of_stiffness = self.elements.mean(density) * self.elements.mean(speed) ** 2 * self.elements.stiffness
        self.mass, self.stiffness = self.elements.matrix(of_mass), self.elements.matrix(of_stiffness)
        self.solver = self.elements.solver(self.elements.matrix(of_mass + time ** 2 / 4 * of_stiffness))

    def start(self, u):
        self.u, self.v = u, numpy.zeros_like(u)
        self.a = self.elements.solve(self.elements.solver(self.mass), -self.elements.times(self.stiffness, u))

    def advance(self):
        ahead = self.u + self.time * self.v + self.time ** 2 / 4 * self.a
        after = self.elements.solve(self.solver, -self.elements.times(self.stiffness, ahead))
        self.u = ahead + self.time ** 2 / 4 * after
        self.v = self.v + self.time / 2 * (self.a + after)
        self.a = after

    def energy(self):
        here = self.v @ self.elements.times(self.mass, self.v) + self.u @ self.elements.times(self.stiffness, self.u)
        return self.comm.allreduce(float(here)) / 2


def main(mesh, steps, time, start):
    comm = MPI.COMM_WORLD
    share = read(comm, mesh)
    points = share.points[:share.own]
    waves = Waves(comm, share, float(time))
    waves.start(standing(points, 0) if start == "standing" else pulse(points, start))
    for step in range(int(steps) + 1):
        if step > 0:
            waves.advance()
        abacus_share.store(share, step, numpy.column_stack([waves.u, waves.v]))
        energy = waves.energy()
        error = comm.allreduce(float(numpy.abs(waves.u - standing(points, step * waves.time)).max(initial=0)), MPI.MAX)
        if comm.rank == 0:
            print(f"step {step}: energy {energy:.9g}" + (f" error {error:.6f}" if start == "standing" else ""), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
