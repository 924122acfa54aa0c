"""How are the lamps to be dimmed for 300 lux on the desk and 100 at the door? No light is solved twice."""

import numpy as np
import office

import deltalux as dl

solution = dl.solve(office.scene(), error=0.1, by_light=True)
desk = dl.SensorGrid.from_surface(solution, "desk.top", spacing=0.2)
door = dl.SensorGrid.from_rectangle((4, 1.5, 0), (1, 0, 0), (0, 1, 0), spacing=0.25)
points, normals = np.concatenate([desk.points, door.points]), np.concatenate([desk.normals, door.normals])

A, lamps = solution.by_light(points, normals)  # lux at each point, of each lamp undimmed
targets = np.repeat([300.0, 100.0], [len(desk), len(door)])
found = dl.design(A, targets)
for lamp, weight in zip(lamps, found.weights):
    print(f"{lamp}: {weight:.2f}")

with solution.edit() as e:
    for lamp, weight in zip(lamps, found.weights):
        e.light(lamp).scale = weight
lux = solution.lux(points, normals)
print(f"desk: {desk.stats(lux[:len(desk)]).Em:.0f} lux; door: {door.stats(lux[len(desk):]).Em:.0f} lux")
print(f"{e.report['rays']} rays; off the sum of columns by {np.abs(lux / found.reached - 1).max():.1%} at most")
