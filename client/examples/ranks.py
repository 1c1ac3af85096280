"""What the ranks of the examples have in common: shares of one state of a mesh, values asked of their owners, and matrices of linear finite elements,
whose rows belong to the rank that has the vertex."""
import glob
import math
import os
import pathlib
import sys

import numpy
import scipy.sparse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
if "PETSC_DIR" not in os.environ:  # Debian sets it where libpetsc-real-dev is installed
    os.environ["PETSC_DIR"] = next(iter(glob.glob("/usr/lib/petscdir/petsc*/*-real")), "")
    sys.path.append(os.path.join(os.environ["PETSC_DIR"], "lib/python3/dist-packages"))

import abacus_share
from petsc4py import PETSc


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


class Elements:
    """Linear elements in the simplices of a share. With one layer it has all simplices at the rank's own vertices, whose rows it assembles alone."""

    def __init__(self, comm, share):
        self.comm, self.share = comm, share
        own, dimension = share.own, share.points.shape[1]
        counts = comm.allgather(own)
        first = sum(counts[:comm.rank])
        # columns have global numbers: first those of rank 0, then of rank 1, and so on
        self.numbers = numpy.concatenate([numpy.arange(own), ask_owners(comm, share, lambda local: first + local) - first]).astype(int) + first
        self.shape = own, sum(counts)
        corners = share.simplices
        edges = share.points[corners[:, 1:]] - share.points[corners[:, :1]]
        volume = numpy.abs(numpy.linalg.det(edges)) / math.factorial(dimension)
        rest = numpy.linalg.inv(edges).transpose(0, 2, 1)
        gradients = numpy.concatenate([-rest.sum(axis=1, keepdims=True), rest], axis=1)
        self.stiffness = volume[:, None, None] * (gradients @ gradients.transpose(0, 2, 1))
        self.mass = volume[:, None, None] * (1 + numpy.eye(dimension + 1)) / ((dimension + 1) * (dimension + 2))

    def mean(self, values):
        """Of the corners of each simplex, to multiply matrices of elements with."""
        return values[self.share.simplices].mean(axis=1)[:, None, None]

    def matrix(self, values, fixed=None, diagonal=0):
        """The rank's rows of a matrix, from those of the simplices. Rows and columns of fixed vertices have nothing but this diagonal."""
        own, corners = self.share.own, self.share.simplices
        fixed = numpy.zeros(len(self.share.id), bool) if fixed is None else fixed
        row, column = numpy.broadcast_arrays(corners[:, :, None], corners[:, None, :])
        wanted = (row < own) & ~fixed[row] & ~fixed[column]
        border = numpy.flatnonzero(fixed[:own])
        entries = numpy.concatenate([values[wanted], numpy.full(len(border), float(diagonal))])
        rows, columns = numpy.concatenate([row[wanted], border]), numpy.concatenate([self.numbers[column[wanted]], self.numbers[border]])
        part = scipy.sparse.csr_matrix((entries, (rows, columns)), self.shape)
        part.sort_indices()
        indices = part.indptr.astype(PETSc.IntType), part.indices.astype(PETSc.IntType)
        return PETSc.Mat().createAIJ(((own, self.shape[1]), (own, self.shape[1])), csr=(*indices, part.data), comm=self.comm)

    def solver(self, matrix):
        solver = PETSc.KSP().create(self.comm)
        solver.setType("cg")
        solver.getPC().setType("jacobi")
        solver.setTolerances(rtol=1e-13)
        solver.setOperators(matrix)
        return solver

    def times(self, matrix, values):
        result = matrix.createVecLeft()
        matrix.mult(PETSc.Vec().createWithArray(values, comm=self.comm), result)
        return result.getArray().copy()

    def solve(self, solver, right):
        solution = solver.getOperators()[0].createVecRight()
        solver.solve(PETSc.Vec().createWithArray(right, comm=self.comm), solution)
        if solver.getConvergedReason() < 0:
            raise ArithmeticError("the solver does not converge")
        return solution.getArray().copy()
