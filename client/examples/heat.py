#!/usr/bin/python3
"""Heat in a square or a cube, by as many ranks as there are: each reads its share of a mesh, and stores its part of each step.

    mpiexec -n 4 client/examples/heat.py MESH [STEPS [REFINED]]

Solves u' = Δu for linear finite elements, implicitly, with PETSc. The mesh is one of the unit square or the unit cube; u is 0 on its border, and
sin(πx) sin(πy) [sin(πz)] at first, so that it is known at all times: it decays by exp(-dπ²t). After REFINED steps the mesh gets points where u bends
most, and is cut anew. Rank 0 prints the greatest error of each step. Connection options come from the environment, as for psql.
"""
import glob
import math
import os
import pathlib
import subprocess
import sys

import numpy
import scipy.sparse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
if "PETSC_DIR" not in os.environ:  # Debian sets it where libpetsc-real-dev is installed
    os.environ["PETSC_DIR"] = next(iter(glob.glob("/usr/lib/petscdir/petsc*/*-real")), "")
    sys.path.append(os.path.join(os.environ["PETSC_DIR"], "lib/python3/dist-packages"))

import abacus_share
from mpi4py import MPI
from petsc4py import PETSc

STEP = 0.002  # time


def read(comm, mesh):
    """The rank's share; all ranks read one snapshot, which rank 0 keeps until they have."""
    if comm.rank == 0:
        with abacus_share.Snapshot() as snapshot:
            comm.bcast(snapshot.name)
            share = snapshot.share(mesh, comm.size, 0)
            comm.barrier()
            return share
    with abacus_share.Snapshot(name=comm.bcast(None)) as snapshot:
        share = snapshot.share(mesh, comm.size, comm.rank)
        comm.barrier()
        return share


def ask_owners(comm, share, answer):
    """answer(local numbers) of the owners, for the vertices of others in the share."""
    own, others = share.own, range(comm.size)
    wanted = [share.id[own:][share.owner[own:] == rank] for rank in others]
    order = numpy.argsort(share.id[:own])
    asked = [order[numpy.searchsorted(share.id[:own], ids, sorter=order)] if len(ids) else numpy.empty(0, int) for ids in comm.alltoall(wanted)]
    return numpy.concatenate(comm.alltoall([answer(numbers) for numbers in asked]))  # by owner, as they are in the share


class Problem:
    """The equations of the rank's own vertices; columns have global numbers: first those of rank 0, then of rank 1, and so on."""

    def __init__(self, comm, share):
        self.comm, self.share = comm, share
        own, dimension = share.own, share.points.shape[1]
        counts = comm.allgather(own)
        first = sum(counts[:comm.rank])
        numbers = numpy.concatenate([numpy.arange(own), ask_owners(comm, share, lambda local: first + local) - first]).astype(int) + first
        corners = share.simplices
        edges = share.points[corners[:, 1:]] - share.points[corners[:, :1]]
        volume = numpy.abs(numpy.linalg.det(edges)) / math.factorial(dimension)
        rest = numpy.linalg.inv(edges).transpose(0, 2, 1)
        gradients = numpy.concatenate([-rest.sum(axis=1, keepdims=True), rest], axis=1)
        stiffness = volume[:, None, None] * (gradients @ gradients.transpose(0, 2, 1))
        mass = volume[:, None, None] * (1 + numpy.eye(dimension + 1)) / ((dimension + 1) * (dimension + 2))
        inside = ((share.points > 0) & (share.points < 1)).all(axis=1)
        row, column = numpy.broadcast_arrays(corners[:, :, None], corners[:, None, :])
        wanted = (row < own) & inside[row] & inside[column]
        shape = own, sum(counts)

        def matrix(values, diagonal):
            border = numpy.flatnonzero(~inside[:own])
            entries = numpy.concatenate([values[wanted], numpy.full(len(border), diagonal)])
            rows, columns = numpy.concatenate([row[wanted], border]), numpy.concatenate([numbers[column[wanted]], numbers[border]])
            part = scipy.sparse.csr_matrix((entries, (rows, columns)), shape)
            part.sort_indices()
            indices = part.indptr.astype(PETSc.IntType), part.indices.astype(PETSc.IntType)
            return PETSc.Mat().createAIJ(((own, shape[1]), (own, shape[1])), csr=(*indices, part.data), comm=comm)

        self.mass = matrix(mass, 0)
        self.solver = PETSc.KSP().create(comm)
        self.solver.setType("cg")
        self.solver.getPC().setType("jacobi")
        self.solver.setTolerances(rtol=1e-13)
        self.solver.setOperators(matrix(mass + STEP * stiffness, 1))

    def advance(self, u):
        """One step of implicit Euler."""
        right, solution = self.mass.createVecLeft(), self.mass.createVecRight()
        self.mass.mult(PETSc.Vec().createWithArray(u, comm=self.comm), right)
        self.solver.solve(right, solution)
        return solution.getArray().copy()


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
