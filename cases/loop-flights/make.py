#!/usr/bin/env python3
"""Makes shots.csv: 80 drives with 6 % more drag than the case declares, each hole in a wind of its own and each ball with a
drag of its own. An integration of its own (Runge-Kutta, 10 ms), standard library only; python3 make.py > shots.csv."""
import math
import random

MASS, RADIUS, DENSITY, VISCOSITY, GRAVITY = 0.04593, 0.021335, 1.225, 1.789e-5, 9.80665
AREA, INERTIA = math.pi * RADIUS**2, 0.4 * MASS * RADIUS**2


def fly(velocity, spin, wind, drag):
    """Carry, side, apex, time, landing angle [m, s, deg] by ferguson-2022 with `drag` times its drag."""
    rate = math.sqrt(sum(w * w for w in spin))
    axis = [w / rate for w in spin]

    def slope(y):
        share = math.log1p(max(0, y[2]) / 0.03) / math.log1p(10 / 0.03)
        u = [y[3] - share * wind[0], y[4] + share * wind[1], y[5]]
        speed = math.sqrt(sum(c * c for c in u))
        s = rate * y[6] * RADIUS / speed
        cd, cl = 0.1304 + s * (0.9287 - 0.8259 * s), 0.0504 + s * (1.2031 - 1.1490 * s)
        k = 0.5 * DENSITY * AREA / MASS * speed
        lift = [axis[1] * u[2] - axis[2] * u[1], axis[2] * u[0] - axis[0] * u[2], axis[0] * u[1] - axis[1] * u[0]]
        a = [k * (cl * lift[i] - drag * cd * u[i]) for i in range(3)]
        a[2] -= GRAVITY
        return y[3:6] + a + [-0.01 * DENSITY * AREA * RADIUS**2 / INERTIA * speed * y[6]]

    y, dt, t, apex = [0, 0, 0, *velocity, 1], 0.01, 0, 0
    while True:
        k1 = slope(y)
        k2 = slope([a + dt / 2 * b for a, b in zip(y, k1)])
        k3 = slope([a + dt / 2 * b for a, b in zip(y, k2)])
        k4 = slope([a + dt * b for a, b in zip(y, k3)])
        n = [a + dt / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(y, k1, k2, k3, k4)]
        apex = max(apex, n[2])
        if n[2] < 0:
            s = y[2] / (y[2] - n[2])
            x = [a + s * (b - a) for a, b in zip(y, n)]
            return (math.hypot(x[0], x[1]), -x[1], apex, t + s * dt,
                    math.degrees(math.atan2(-x[5], math.hypot(x[3], x[4]))))
        y, t = n, t + dt


def main():
    draw = random.Random(7).gauss
    holes = [(draw(0, 1.5), draw(0, 1.5)) for _ in range(5)]
    print("shot,hole,ball_speed_mps,launch_angle_deg,azimuth_deg,spin_rate_rpm,spin_axis_deg,"
          "carry_m,side_m,apex_m,flight_time_s,landing_angle_deg")
    for i in range(80):
        speed, up, right = draw(74, 4), draw(11.5, 2.5), draw(0, 2.5)
        rpm, tilt = draw(2700, 500), draw(0, 7)
        u, r, w, x = math.radians(up), math.radians(right), rpm * math.pi / 30, math.radians(tilt)
        velocity = [speed * math.cos(u) * math.cos(r), -speed * math.cos(u) * math.sin(r), speed * math.sin(u)]
        spin = [0, -w * math.cos(x), -w * math.sin(x)]
        read = fly(velocity, spin, holes[i % 5], 1.06 * (1 + draw(0, 0.02)))
        carry, side, apex, time, angle = (v + draw(0, e) for v, e in zip(read, (1.5, 1.5, 0.4, 0.04, 0.7)))
        print(f"{i + 1},h{i % 5 + 1},{draw(speed, 0.15):.2f},{draw(up, 0.1):.2f},{draw(right, 0.1):.2f},"
              f"{draw(rpm, 50):.0f},{draw(tilt, 1.5):.1f},{carry:.1f},{side:.1f},{apex:.1f},{time:.2f},{angle:.1f}")


main()
