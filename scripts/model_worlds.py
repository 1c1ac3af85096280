"""What the model tests have in common: worlds at random, one after the other, until time is over or one fails."""
import argparse
import collections
import random
import sys
import time

from psql_session import Failure


def main(description, world_of, agree, *arguments):
    """Lives through worlds: world_of(seed, number, options, done), with live(end) and close(keep). `agree`: what is said at the end, of
    what the counter `done` has; `arguments`: names of options more."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-t", "--seconds", type=float, default=60)
    parser.add_argument("-n", "--worlds", type=int, default=10 ** 9)
    parser.add_argument("-s", "--seed", type=int, default=random.SystemRandom().randrange(10 ** 9))
    parser.add_argument("-w", "--world", type=int, help="only this one")
    for name in ("--folder", *arguments):
        parser.add_argument(name, required=True)
    options = parser.parse_args()
    done = collections.Counter()
    end = time.monotonic() + options.seconds if options.world is None else float("inf")
    first, last = (options.world, options.world) if options.world is not None else (1, options.worlds)
    print(f"seed {options.seed}", flush=True)
    for number in range(first, last + 1):
        world = world_of(options.seed, number, options, done)
        try:
            world.live(end)
        except Failure as failure:
            world.close(keep=True)
            print(f"{failure}\nFAILED: seed {options.seed}, world {number}: run again with -s {options.seed} -w {number}; its SQL is in {world.script}")
            sys.exit(1)
        world.close(keep=False)
        done["worlds"] += 1
        if time.monotonic() > end:
            break
    for what in sorted(done):
        print(f"{done[what]:8} {what}")
    print(agree.format_map(done), f"(seed {options.seed})")
