"""Golden flights: shots with a raised cue on the textbook's table with a cloth restitution of one half (e_c = 0.5), computed
with 50 digits by a program that shares no code with the simulator: mpmath, one landing after another instead of closed
sums, and all roots of every polynomial instead of bracketing.

    python3 tests/data/flights.py > tests/data/flights.jsonl

The equations are those of docs/physics.md: motion on the cloth, the stroke, impacts in space, the cloth's reaction.
"""

import json
import math
import random
import sys

from mpmath import mp, mpf, polyroots, sqrt, cos, sin, fabs, radians

mp.dps = 50

L, W, R = mpf("2.84"), mpf("1.42"), mpf("0.03075")
MASS, CUE = mpf("0.21"), mpf("0.54")
MU_S, MU_R, MU_SP, G = mpf("0.2"), mpf("0.010"), mpf("0.0124"), mpf("9.81")
E_BALL, MU_BALL, E_RAIL, MU_RAIL = mpf("0.95"), mpf("0.06"), mpf("0.85"), mpf("0.2")
E_CLOTH, MU_CLOTH = mpf("0.5"), MU_S
SLIDE, ROLL, SPIN = MU_S * G, mpf(5) / 7 * MU_R * G, mpf(5) / 2 * MU_SP * G / R
# A hop slower than this counts as ended.
LAST_HOP = mpf(10) ** -32
NEVER = mpf("inf")
NORMALS = {"left": (1, 0), "right": (-1, 0), "bottom": (0, 1), "top": (0, -1)}


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def plus(a, b, share=1):
    return [x + share * y for x, y in zip(a, b)]


def size(a):
    return sqrt(dot(a, a))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class Ball:
    def __init__(self, x, y):
        self.p, self.v, self.w = [mpf(x), mpf(y), mpf(0)], [mpf(0)] * 3, [mpf(0)] * 3
        self.mode = "rest"

    def slip(self):
        return [self.v[0] - R * self.w[1], self.v[1] + R * self.w[0]]

    def settle(self):
        """Sets the equation of motion from the state."""
        small = mpf(10) ** -40
        if self.mode == "off":
            return
        if self.p[2] > 0 or self.v[2] > 0:
            self.mode = "fly"
        elif size(self.slip()) > small:
            self.mode = "slide"
        elif size(self.v[:2]) > small:
            self.mode = "roll"
        else:
            self.v = [mpf(0)] * 3
            self.mode = "rest"

    def acceleration(self):
        if self.mode == "fly":
            return [mpf(0), mpf(0), -G]
        if self.mode == "slide":
            u = self.slip()
            return [-SLIDE * u[0] / size(u), -SLIDE * u[1] / size(u), mpf(0)]
        if self.mode == "roll":
            speed = size(self.v)
            return [-ROLL * self.v[0] / speed, -ROLL * self.v[1] / speed, mpf(0)]
        return [mpf(0)] * 3

    def lasts(self):
        if self.mode == "fly":
            return (self.v[2] + sqrt(self.v[2] ** 2 + 2 * G * self.p[2])) / G
        if self.mode == "slide":
            return 2 * size(self.slip()) / (7 * SLIDE)
        if self.mode == "roll":
            return size(self.v) / ROLL
        return NEVER

    def advance(self, t):
        a = self.acceleration()
        if self.mode in ("slide", "roll", "rest") and self.w[2] != 0:
            left = fabs(self.w[2]) - SPIN * t
            self.w[2] = left * (1 if self.w[2] > 0 else -1) if left > 0 else mpf(0)
        if self.mode == "slide":
            # w' = 5/(2R) z x (direction of the slip velocity times mu_s g)
            self.w[0] += t * mpf(5) / (2 * R) * a[1]
            self.w[1] -= t * mpf(5) / (2 * R) * a[0]
        self.p = [p + t * v + t * t * b / 2 for p, v, b in zip(self.p, self.v, a)]
        self.v = plus(self.v, a, t)
        if self.mode == "roll":
            self.w[0], self.w[1] = -self.v[1] / R, self.v[0] / R

    def press(self):
        """Applies the cloth's reaction to a ball on it that moves downwards."""
        if self.v[2] >= 0:
            return
        push = -(1 + E_CLOTH) * self.v[2]
        u = self.slip()
        s = size(u)
        if s > 0:
            f = min(MU_CLOTH * push, 2 * s / 7)
            self.v[0] -= f * u[0] / s
            self.v[1] -= f * u[1] / s
            # r x J with r = -R z
            self.w[0] -= mpf(5) / (2 * R) * f * u[1] / s
            self.w[1] += mpf(5) / (2 * R) * f * u[0] / s
        self.v[2] *= -E_CLOTH
        if self.v[2] < LAST_HOP:
            self.v[2] = mpf(0)


def strike(ball, cue):
    a, b, phi, v = mpf(cue["a"]), mpf(cue["b"]), radians(mpf(cue["phi_deg"])), mpf(cue["speed"])
    theta = radians(mpf(cue["theta_deg"]))
    c = sqrt(1 - a * a - b * b)
    lever = b * cos(theta) - c * sin(theta)
    force = 2 * v / (1 + MASS / CUE + mpf(5) / 2 * (a * a + lever * lever))
    ball.v = [force * cos(theta) * cos(phi), force * cos(theta) * sin(phi), -force * sin(theta)]
    k = mpf(5) / 2 * force / R
    ball.w = [
        k * (-lever * sin(phi) - a * sin(theta) * cos(phi)),
        k * (lever * cos(phi) - a * sin(theta) * sin(phi)),
        -k * a * cos(theta),
    ]
    ball.press()
    ball.settle()


def first_fall(coefficients, limit, touching):
    """Returns the first time after zero at which a polynomial, lowest coefficient first, falls through zero."""
    c = list(coefficients)
    if touching:
        if c[1] < 0:
            return mpf(0)
        c = c[1:]
    while len(c) > 1 and fabs(c[-1]) < mpf(10) ** -45:
        c.pop()
    if len(c) < 2:
        return NEVER
    slope = [i * x for i, x in enumerate(c)][1:]
    value = lambda p, t: sum(x * t**i for i, x in enumerate(p))
    best = NEVER
    for root in polyroots(c[::-1], maxsteps=500, extraprec=120):
        real = root.real
        if fabs(root.imag) < mpf(10) ** -25 and mpf(10) ** -30 < real <= limit and value(slope, real) < 0:
            best = min(best, real)
    return best


def far(d, limit, reach):
    """Whether |d0 + d1 t + d2 t^2| certainly stays above the distance `reach`."""
    return limit < NEVER and size(d[0]) - reach > size(d[1]) * limit + size(d[2]) * limit**2 + mpf(10) ** -9


def square(d):
    """Returns the coefficients of |d0 + d1 t + d2 t^2|^2."""
    return [
        dot(d[0], d[0]),
        2 * dot(d[0], d[1]),
        dot(d[1], d[1]) + 2 * dot(d[0], d[2]),
        2 * dot(d[1], d[2]),
        dot(d[2], d[2]),
    ]


class Shot:
    def __init__(self, layout, cue):
        self.balls = [Ball(x, y) for x, y in layout]
        self.t, self.events, self.trouble = mpf(0), [], False
        self.aloft_meetings = 0
        strike(self.balls[0], cue)
        if self.balls[0].mode == "fly":
            self.tell("jumps", 0)

    def tell(self, kind, *balls, rail=None):
        event = {"t": float(self.t), "kind": kind, "balls": list(balls)}
        if rail:
            event["rail"] = rail
        self.events.append(event)

    def rail_ahead(self, ball, limit):
        """Returns time and rail of the contact with a nose, a line at the height of the centre, or "over" if the ball passes it."""
        best = (NEVER, None)
        if ball.mode in ("rest", "off"):
            return best
        a = ball.acceleration()
        for rail, n in NORMALS.items():
            n = [mpf(x) for x in n]
            edge = L / 2 if n[0] else W / 2
            # The vector from the nose to the centre: inwards and upwards.
            way = [
                [edge + dot(n, ball.p[:2]), ball.p[2]],
                [dot(n, ball.v[:2]), ball.v[2]],
                [dot(n, a[:2]) / 2, a[2] / 2],
            ]
            c = square(way)
            c[0] -= R * R
            t = NEVER if far(way, limit, R) else first_fall(c, limit, fabs(c[0]) < mpf(10) ** -35)
            if t < best[0]:
                inwards = way[0][0] + t * way[1][0] + t * t * way[2][0]
                if inwards > 0:
                    best = (t, rail)
            if ball.mode == "fly":
                down = ball.v[2] ** 2 + 2 * G * (ball.p[2] - R)
                if down >= 0:
                    t = (ball.v[2] + sqrt(down)) / G
                    inwards = way[0][0] + t * way[1][0]
                    if 0 < t <= limit and inwards <= 0 and t < best[0]:
                        best = (t, "over")
        return best

    def pair_ahead(self, one, other, limit):
        if "off" in (one.mode, other.mode) or (one.mode == "rest" and other.mode == "rest"):
            return NEVER
        a, b = one.acceleration(), other.acceleration()
        d = [plus(one.p, other.p, -1), plus(one.v, other.v, -1), plus([x / 2 for x in a], [x / 2 for x in b], -1)]
        if far(d, limit, 2 * R):
            return NEVER
        c = square(d)
        c[0] -= 4 * R * R
        return first_fall(c, limit, fabs(c[0]) < mpf(10) ** -35)

    def collide(self, i, j):
        one, other = self.balls[i], self.balls[j]
        n = plus(one.p, other.p, -1)
        n = [x / size(n) for x in n]
        apart = plus(one.v, other.v, -1)
        push = -(1 + E_BALL) / 2 * dot(apart, n)
        if push < mpf("1e-3"):
            self.trouble = True
        s = plus(apart, n, -dot(apart, n))
        s = plus(s, cross(plus(one.w, other.w), n), -R)
        f = mpf(1) / 7 if size(s) == 0 else min(mpf(1) / 7, MU_BALL * push / size(s))
        twist = cross(n, s)
        for ball, sign in ((one, 1), (other, -1)):
            in_air = ball.mode == "fly"
            ball.v = plus(ball.v, plus([push * x for x in n], s, -f), sign)
            ball.w = plus(ball.w, twist, 5 * f / (2 * R))
            if not in_air and one.mode != "fly" and other.mode != "fly":
                ball.v[2] = mpf(0)
        flew = one.mode == "fly" or other.mode == "fly"
        self.aloft_meetings += flew
        self.tell("ball-ball", i, j)
        for index in (i, j):
            ball = self.balls[index]
            before = ball.mode
            if ball.p[2] <= 0 and flew:
                ball.p[2] = mpf(0)
                ball.press()
            ball.settle()
            if ball.mode == "fly" and before != "fly":
                self.tell("jumps", index)

    def rebound(self, i, rail):
        ball = self.balls[i]
        n = [mpf(x) for x in NORMALS[rail]] + [mpf(0)]
        edge = L / 2 if n[0] else W / 2
        flew = ball.mode == "fly"
        self.aloft_meetings += flew
        inwards = edge + dot(n[:2], ball.p[:2])
        d = [-inwards * n[0], -inwards * n[1], -ball.p[2]]
        d = [x / size(d) for x in d]
        approach = dot(ball.v, d)
        push = (1 + E_RAIL) * approach
        if push < mpf("2e-2"):
            self.trouble = True
        s = plus(ball.v, d, -approach)
        s = plus(s, cross(ball.w, d), R)
        f = mpf(2) / 7 if size(s) == 0 else min(mpf(2) / 7, MU_RAIL * push / size(s))
        ball.v = plus(plus(ball.v, d, -push), s, -f)
        ball.w = plus(ball.w, cross(d, s), -5 * f / (2 * R))
        if not flew:
            ball.v[2] = mpf(0)
        self.tell("ball-rail", i, rail=rail)
        if flew and ball.p[2] <= 0:
            ball.press()
        ball.settle()

    def play(self):
        for _ in range(900):
            alone = [ball.lasts() for ball in self.balls]
            best = (NEVER, None)
            for i, ball in enumerate(self.balls):
                best = min(best, (alone[i], ("end", i)), key=lambda x: x[0])
            for i, ball in enumerate(self.balls):
                t, rail = self.rail_ahead(ball, min(best[0], alone[i]))
                if t < best[0]:
                    best = (t, ("rail", i, rail))
            for i, j in ((0, 1), (0, 2), (1, 2)):
                t = self.pair_ahead(self.balls[i], self.balls[j], best[0])
                if t < best[0]:
                    best = (t, ("pair", i, j))
            t, what = best
            if t == NEVER:
                return True
            modes = [ball.mode for ball in self.balls]
            for ball in self.balls:
                ball.advance(t)
            self.t += t
            if what[0] == "pair":
                self.collide(what[1], what[2])
            elif what[0] == "rail" and what[2] == "over":
                ball = self.balls[what[1]]
                ball.mode, ball.v = "off", [mpf(0)] * 3
                self.tell("leaves-table", what[1])
            elif what[0] == "rail":
                self.rebound(what[1], what[2])
            else:
                i = what[1]
                ball, before = self.balls[i], modes[what[1]]
                if before == "fly":
                    ball.p[2] = mpf(0)
                    ball.press()
                elif before == "slide":
                    ball.w[0], ball.w[1] = -ball.v[1] / R, ball.v[0] / R
                else:
                    ball.v = [mpf(0)] * 3
                    ball.w[0] = ball.w[1] = mpf(0)
                ball.settle()
                if before == "fly" and ball.mode != "fly":
                    self.tell("lands", i)
                if before != "roll" and ball.mode == "roll":
                    self.tell("sliding-rolling", i)
                if ball.mode == "rest" and before != "rest":
                    if before == "slide":
                        self.tell("sliding-rolling", i)
                    self.tell("rolling-stationary", i)
            if self.trouble:
                return False
        return False


def final(layout, cue):
    shot = Shot(layout, cue)
    return shot if shot.play() else None


def condition(layout, cue, end):
    worst = mpf(0)
    step = mpf(10) ** -18
    for key in ("speed", "phi_deg", "theta_deg", "a", "b"):
        other = dict(cue)
        other[key] = mpf(cue[key]) * (1 + step)
        moved = final(layout, other)
        if moved is None or [e["kind"] for e in moved.events] != [e["kind"] for e in end.events]:
            return None
        for one, two in zip(end.balls, moved.balls):
            worst = max(worst, size(plus(one.p[:2], two.p[:2], -1)) / step)
    return worst


def main():
    rng = random.Random(20)
    wanted = {"meets": 36, "hops": 16, "off": 8}
    while any(wanted.values()):
        layout = [[round(rng.uniform(-1.3, 1.3), 6), round(rng.uniform(-0.6, 0.6), 6)] for _ in range(3)]
        theta = rng.choice([3, 8, 20, 35, 50, 65, 80]) + rng.random()
        phi = rng.uniform(-180, 180)
        if rng.random() < 0.7:
            # A ball in the path.
            way, off = rng.uniform(0.08, 0.6), math.radians(phi + rng.uniform(-8, 8))
            layout[1] = [layout[0][0] + way * math.cos(off), layout[0][1] + way * math.sin(off)]
        apart = [size(plus([mpf(x) for x in layout[i]], [mpf(x) for x in layout[j]], -1)) for i, j in ((0, 1), (0, 2), (1, 2))]
        if min(apart) < mpf("0.07") or max(abs(y[1]) for y in layout) > 0.66 or max(abs(y[0]) for y in layout) > 1.36:
            continue
        cue = {
            "a": rng.uniform(-0.35, 0.35),
            "b": rng.uniform(-0.35, 0.35),
            "theta_deg": theta,
            "phi_deg": phi,
            "speed": rng.uniform(1, 6),
        }
        shot = final(layout, cue)
        if shot is None:
            continue
        off = any(ball.mode == "off" for ball in shot.balls)
        sort = "off" if off else "meets" if shot.aloft_meetings else "hops"
        if not wanted[sort]:
            continue
        worst = condition(layout, cue, shot)
        if worst is None or worst > mpf(10) ** 9:
            continue
        wanted[sort] -= 1
        line = {
            "preset": "textbook",
            "layout": layout,
            "cue": cue,
            "duration": float(shot.events[-1]["t"]),
            "condition": float(worst),
            "events": shot.events,
            "final": [[float(x) for x in ball.p[:2]] for ball in shot.balls],
        }
        print(json.dumps(line), flush=True)
        print(wanted, file=sys.stderr, flush=True)


main()
