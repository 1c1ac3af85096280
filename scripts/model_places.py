"""Random places for model_test.py, of the kinds that make triangulations difficult."""


class Places:
    """Random places of a kind."""

    KINDS = ("uniform", "grid", "few", "flat", "clusters", "exponents", "sphere")

    def __init__(self, chance, dimension):
        self.chance = chance
        self.dimension = dimension
        self.centres = [[chance.uniform(-1, 1) for _ in range(dimension)] for _ in range(3)]

    def place(self, kind):
        """A place, as a list of coordinates."""
        chance, axes = self.chance, range(self.dimension)
        if kind == "grid":
            return [chance.randrange(24) for _ in axes]
        if kind == "few":
            return [chance.randrange(3) for _ in axes]
        if kind == "flat":
            place = [chance.randrange(-20, 20) / 4 for _ in axes]
            place[-1] = 2 * place[0] + 1
            return place
        if kind == "clusters":
            return [c + chance.gauss(0, 1e-9) for c in chance.choice(self.centres)]
        if kind == "exponents":
            return [chance.choice((-1, 1)) * 10.0 ** chance.randrange(-120, 120) for _ in axes]
        if kind == "sphere":  # whole numbers on one circle, or sphere
            place = list(chance.choice(((3, 4, 0), (5, 0, 0)))[:self.dimension])
            chance.shuffle(place)
            return [chance.choice((-1, 1)) * x for x in place]
        return [chance.uniform(0, 1) for _ in axes]
