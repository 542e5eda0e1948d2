# %% A morning with hosel in Python. Run it as a script, or cell by cell in an editor that knows `# %%`.
# The figure is drawn where matplotlib is installed.
import sys
import tempfile
from pathlib import Path

import numpy as np

import hosel

out = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp())

# %% One reduced model, ten thousand drives: club, ball and contact are those of a shipped case.
model = hosel.Model("driver-toe", "rigid-eccentric")
random = np.random.default_rng(1)
toe, high = random.normal(0, 9, 10_000), random.normal(0, 6, 10_000)
drives = model.launch(club_speed_mph=random.normal(105, 1.5, 10_000), impact_toe_mm=toe, impact_high_mm=high)
print(f"{model.name}: ball speed {drives['ball_speed_mps'].mean():.1f} +- {drives['ball_speed_mps'].std():.1f} m/s")

# %% Gear effect: sidespin against the place on the face.
slope = np.polyfit(toe, drives["sidespin_rpm"], 1)[0]
print(f"{slope:.0f} rpm of sidespin for each mm towards the toe (negative: a draw)")

# %% A map over the face, on a grid.
grid = np.meshgrid(np.linspace(-20, 20, 41), np.linspace(-12, 12, 25))
speed = model.launch(impact_toe_mm=grid[0], impact_high_mm=grid[1])["ball_speed_mps"]
best = np.unravel_index(speed.argmax(), speed.shape)
print(f"fastest ball {grid[0][best]:.0f} mm towards the toe, {grid[1][best]:.0f} mm up the face")

# %% A study: any key of the case, on a grid of two axes, kept on disk and resumed if it is killed.
study = hosel.Study("driver-toe", set=['models=["rigid-eccentric"]'], outputs=["models.rigid-eccentric.ball_speed_mps"])
found = study.grid(out / "heads", {"head.mass_kg": [0.19, 0.2, 0.21], "delivery.impact_toe_mm": [0, 15]}, force=True)
print(found["models.rigid-eccentric.ball_speed_mps"])

# %% The same blow with a finite-element ball, coarse enough for a second of computing.
run = hosel.run("driver-toe", out / "toe", force=True,
                set=['models=["fe-free-body"]', "accuracy=look", "output.vtk=false"])
launch = run.launches()["fe-free-body"]
print(f"finite elements: {launch['ball_speed_mps']:.2f} m/s, backspin {launch['backspin_rpm']:.0f} rpm")

# %% Its history: every step of the contact.
history = run["history.csv"]
print(", ".join(history))
solution = run.summary["models"]["fe-free-body"]["solution"]
print(f"largest force {solution['peak_force_N'] / 1e3:.2f} kN at {solution['peak_time_ms']:.3f} ms")

# %%
try:
    axes = history.plot("time_s", "normal_force_N")
    axes.figure.savefig(out / "force.png", dpi=120)
    print("drawn:", out / "force.png")
except ImportError:
    print("no matplotlib: no figure")
