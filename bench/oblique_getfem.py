#!/usr/bin/env python3
"""An elastic ball thrown obliquely at a rigid wall, by GetFEM in three dimensions and by hosel (cases/elastic-oblique).

GetFEM (package python3-getfem) shares neither mesh nor contact method with hosel: half a ball of quadratic 27-node
bricks, unilateral contact and Coulomb friction by an augmented Lagrangian with multipliers on the patch, the
generalized-alpha method (spectral radius 0.5). St Venant-Kirchhoff, 60 MPa, nu = 0.3, R = 21.335 mm, 45.93 g.

Exit status 77 and a sentence where GetFEM is not installed.
"""
import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

try:
    import getfem as gf
except ImportError:
    gf = None

# mm, t, s, N: multipliers and displacements are then of one size.
RADIUS, MASS, YOUNG, POISSON = 21.335, 45.93e-6, 60.0, 0.3
DENSITY = MASS / (4 / 3 * math.pi * RADIUS**3)


def graded(count, fine):
    """`count` + 1 places on [-1, 1]; the middle cells `fine` times an even one."""
    s = np.linspace(-1, 1, count + 1)
    return fine * s + (1 - fine) * s**3


def half_ball(across, layers):
    """Bricks of half a ball (y >= 0): a block amid, and shells of `layers` bricks about it, fine towards the pole
    z = -R. Each is 27 points, the first coordinate running fastest; and whether it has a face on the lower pole's side."""
    x = graded(2 * (across // 2), 0.55)
    y = x[len(x) // 2:]
    z = np.linspace(-1, 1, max(4, across // 2) + 1)
    # Of a shell: from the inner block (0) to the sphere (1), thinner outwards.
    depth = 1 - (1 - np.linspace(0, 1, layers + 1))**1.5

    def place(p):
        """A point of the cube [-1, 1]^3 in the ball; the block is the cube's inner half."""
        most = np.max(np.abs(p))
        if most == 0:
            return np.zeros(3)
        face = p / most  # on the cube's surface
        sphere = np.tan(face * math.pi / 4)
        sphere = sphere / np.linalg.norm(sphere)
        inner = 0.5 * (0.75 * face / math.sqrt(1.6) + 0.25 * sphere)  # a bulged cube
        if most <= 0.5:
            return RADIUS * inner * (most / 0.5)
        t = (most - 0.5) / 0.5
        return RADIUS * ((1 - t) * inner + t * sphere)

    def lines(nodes):
        return [(nodes[i], 0.5 * (nodes[i] + nodes[i + 1]), nodes[i + 1]) for i in range(len(nodes) - 1)]

    bricks = []

    def block(a, b, c, to_cube, pole=False):
        for k, cs in enumerate(lines(c)):
            for bs in lines(b):
                for s in lines(a):
                    points = np.array([place(to_cube(u, v, w)) for w in cs for v in bs for u in s])
                    bricks.append((points, pole and k == len(lines(c)) - 1))

    block(x / 2, y / 2, z / 2, lambda u, v, w: np.array([u, v, w]))
    radial = 0.5 + 0.5 * depth
    block(y, x, radial, lambda u, v, w: w * np.array([v, u, -1.0]), pole=True)  # below
    block(x, y, radial, lambda u, v, w: w * np.array([u, v, 1.0]))  # above
    block(y, z, radial, lambda u, v, w: w * np.array([1.0, u, v]))
    block(z, y, radial, lambda u, v, w: w * np.array([-1.0, v, u]))
    block(z, x, radial, lambda u, v, w: w * np.array([v, 1.0, u]))
    return bricks


def by_getfem(o):
    began = time.process_time()
    gf.util_trace_level(1)
    mesh = gf.Mesh("empty", 3)
    brick = gf.GeoTrans("GT_QK(3,2)")
    bricks = half_ball(o.across, o.layers)
    for points, _ in bricks:
        mesh.add_convex(brick, points.T)
    outer = mesh.outer_faces()
    low, flat = [], []
    for column in outer.T:
        face_points = mesh.pts()[:, mesh.pid_in_faces(np.array([[column[0]], [column[1]]]))]
        if np.all(np.abs(face_points[1]) < 1e-6):
            flat.append(column)
        elif np.all(face_points[2] < -0.55 * RADIUS):
            low.append(column)
    PATCH, FLAT = 1, 2
    mesh.set_region(PATCH, np.array(low).T)
    mesh.set_region(FLAT, np.array(flat).T)

    field = gf.MeshFem(mesh, 3)
    field.set_fem(gf.Fem("FEM_QK(3,2)"))
    multiplier = gf.MeshFem(mesh, 3)
    multiplier.set_fem(gf.Fem("FEM_QK(3,1)"))
    volume = gf.MeshIm(mesh, gf.Integ("IM_GAUSS_PARALLELEPIPED(3,5)"))

    dt = o.duration / o.steps
    # Generalized alpha: M a at 1 - alpha_m, forces at 1 - alpha_f of the step; the unknown is the displacement there.
    radius = 0.5
    alpha_m, alpha_f = (2 * radius - 1) / (radius + 1), radius / (radius + 1)
    gamma = 0.5 + alpha_f - alpha_m
    beta = (gamma + 0.5) ** 2 / 4
    model = gf.Model("real")
    model.add_fem_variable("u", field)  # displacement
    model.add_filtered_fem_variable("touch", multiplier, PATCH)  # traction on the ball
    size = field.nbdof()
    model.add_initialized_fem_data("u0", field, np.zeros(size))
    v0 = np.zeros((3, size // 3), order="F")
    angle = math.radians(o.angle)
    v0[0], v0[2] = 1e3 * o.speed * math.sin(angle), -1e3 * o.speed * math.cos(angle)
    velocity = v0.flatten(order="F")
    model.add_initialized_fem_data("v0", field, velocity)
    model.add_initialized_fem_data("d", field, np.zeros(size))
    inertia = (1 - alpha_m) / (beta * dt * dt)
    for name, value in {"rho": DENSITY, "c": inertia / (1 - alpha_f), "R": RADIUS, "mu": o.friction,
                        "r": o.augmentation,
                        "lambda": YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)),
                        "G": YOUNG / (2 * (1 + POISSON))}.items():
        model.add_initialized_data(name, value)
    model.add_nonlinear_term(volume, "rho*(c*u-d).Test_u")
    strain = "(0.5*(Grad_u+Grad_u'+Grad_u'*Grad_u))"
    model.add_nonlinear_term(volume, f"((Id(3)+Grad_u)*(lambda*Trace({strain})*Id(3)+2*G*{strain})):Grad_Test_u")
    model.add_linear_term(volume, "1e5*u(2)*Test_u(2)", FLAT)
    push = "pos_part(touch(3)-r*(X(3)+u(3)+R))"
    slide = f"Ball_projection([touch(1)-r*(u(1)-u0(1));touch(2)-r*(u(2)-u0(2));0],mu*{push})"
    model.add_nonlinear_term(volume, "-touch.Test_u", PATCH)
    model.add_nonlinear_term(volume, f"(1/r)*(touch-{slide}-[0;0;{push}]).Test_touch", PATCH)

    def integral(expression, region=-1):
        return float(gf.asm_generic(volume, 0, expression, region, model))

    print(f"GetFEM {gf_version()}: {len(bricks)} bricks, {size} equations, {o.steps} steps", file=sys.stderr)
    u, acceleration = np.zeros(size), np.zeros(size)
    largest = 0.0
    forces = []
    for step in range(o.steps):
        ahead = u + dt * velocity + dt * dt * (0.5 - beta) * acceleration  # without the new acceleration
        model.set_variable("d", inertia * (alpha_f / (1 - alpha_f) * u + ahead) - alpha_m * acceleration)
        model.set_variable("u", u + (1 - alpha_f) * dt * velocity)
        # Contact is not smooth: whole steps of Newton, without a line search.
        iterations, converged = model.solve("max_res", o.residual, "max_iter", 40, "lsearch", "simplest", "alpha min", 1,
                                            "alpha max ratio", 1e12)
        if not converged:
            sys.exit(f"GetFEM has not converged in step {step + 1}")
        new = (model.variable("u") - alpha_f * u) / (1 - alpha_f)
        later = (new - ahead) / (beta * dt * dt)
        velocity = velocity + dt * ((1 - gamma) * acceleration + gamma * later)
        u, acceleration = new, later
        normal, tangential = 2 * integral("touch(3)", PATCH), 2 * integral("touch(1)", PATCH)
        forces.append((dt * (step + 1 - alpha_f), normal, tangential))
        largest = max(largest, normal)
        model.set_variable("u0", u)
        model.set_variable("v0", velocity)
        if o.noisy:
            print(f"{step + 1:4d} {1e3 * dt * (step + 1):.3f} ms  {normal:8.1f} N {tangential:8.1f} N  {iterations} iterations",
                  file=sys.stderr)
        if largest > 0 and normal < 1e-3 * largest and step > o.steps // 3:
            break
    half_mass = integral("rho")
    centre = [integral(f"rho*(X({i})+u0({i}))") / half_mass for i in (1, 2, 3)]
    v = [1e-3 * integral(f"rho*v0({i})") / half_mass for i in (1, 2, 3)]
    turn = integral(f"rho*((X(3)+u0(3)-({centre[2]}))*v0(1)-(X(1)+u0(1)-({centre[0]}))*v0(3))")
    spin = 2 * turn / (0.4 * MASS * RADIUS**2)  # [rad/s]
    return {"v_t": v[0], "v_n": v[2], "R_omega": 1e-3 * RADIUS * spin, "peak_N": largest, "mass_g": 2e6 * half_mass,
            "kinetic_share": 2 * integral("0.5*rho*v0.v0") / (0.5 * MASS * (1e3 * o.speed) ** 2), "bricks": len(bricks),
            "equations": size, "cpu_s": time.process_time() - began, "forces": forces}


def gf_version():
    said = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", "python3-getfem"], capture_output=True, text=True)
    return said.stdout or "(version unknown)"


def by_hosel(o):
    with tempfile.TemporaryDirectory() as folder:
        case = Path(__file__).resolve().parent.parent / "cases/elastic-oblique"
        settings = {"delivery.club_speed_mps": o.speed, "delivery.club_path_deg": o.angle, "contact.face_friction": o.friction,
                    "mesh.sector": 4, "mesh.rings": 4, "time.steps_per_contact": 120}
        words = [w for k, v in settings.items() for w in ("--set", f"{k}={v}")]
        subprocess.run([o.hosel, "run", str(case), "--quiet", "--out", folder + "/out", *words], check=True)
        launch = json.loads((Path(folder) / "out/summary.json").read_text())["models"]["fe-free-body"]
    azimuth, angle = math.radians(launch["azimuth_deg"]), math.radians(o.angle)
    return {"v_t": o.speed * math.sin(angle) - launch["ball_speed_mps"] * math.sin(azimuth),
            "v_n": launch["ball_speed_mps"] * math.cos(azimuth) - o.speed * math.cos(angle),
            "R_omega": 1e-3 * RADIUS * launch["spin_rate_rpm"] * math.pi / 30, "peak_N": launch["solution"]["peak_force_N"]}


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("--hosel", default=str(Path(__file__).resolve().parent.parent / "build/release/bin/hosel"))
    ask.add_argument("--angle", type=float, default=25, help="from the normal [deg]")
    ask.add_argument("--speed", type=float, default=10, help="of the ball [m/s]")
    ask.add_argument("--friction", type=float, default=0.3, help="coefficient of Coulomb friction [-]")
    ask.add_argument("--across", type=int, default=8, help="bricks across the ball's inner block")
    ask.add_argument("--layers", type=int, default=3, help="layers of bricks from the block to the surface")
    ask.add_argument("--steps", type=int, default=80, help="steps in the duration")
    ask.add_argument("--duration", type=float, default=1.0e-3, help="longest time that is followed [s]")
    ask.add_argument("--augmentation", type=float, default=50.0, help="of the multipliers [N/mm^3]")
    ask.add_argument("--residual", type=float, default=1e-7, help="at which Newton's method stops [N]")
    ask.add_argument("--ours", action="store_true", help="hosel alone")
    ask.add_argument("--noisy", action="store_true", help="a line a step")
    ask.add_argument("--out", help="file for all numbers and the forces over time (JSON)")
    o = ask.parse_args()
    if o.ours:
        ours = by_hosel(o)
        print("\n".join(f"{key:8}{value:10.5g}" for key, value in ours.items()))
        if o.out:
            Path(o.out).write_text(json.dumps({"hosel": ours}))
        return
    if gf is None:
        print("SKIPPED: GetFEM is not installed (apt-get install python3-getfem)")
        sys.exit(77)
    peer, ours = by_getfem(o), by_hosel(o)
    print(f"{'':10}{'GetFEM':>10}{'hosel':>10}{'hosel over GetFEM':>20}")
    for key, unit in {"v_n": "m/s", "v_t": "m/s", "R_omega": "m/s", "peak_N": "N"}.items():
        print(f"{key:8}{peer[key]:12.5g}{ours[key]:10.5g}{100 * (ours[key] / peer[key] - 1):18.2f} %  {unit}")
    print(f"GetFEM {gf_version()}: {peer['bricks']} bricks, {peer['equations']} equations, {peer['cpu_s']:.0f} CPU s")
    if o.out:
        Path(o.out).write_text(json.dumps({"getfem": peer, "hosel": ours}))


if __name__ == "__main__":
    main()
