"""Where is the desk best? It is dragged along the room, and each place costs an update, not a solve."""

import office

import deltalux as dl

solution = dl.solve(office.scene(), error=0.1)
step, best = 0.5, (0.0, 0.0)
for i in range(5):
    if i > 0:
        with solution.edit() as e:
            e.move("desk", translate=(step, 0, 0))
    grid = dl.SensorGrid.from_surface(solution, "desk.top", spacing=0.2)
    stats = grid.stats(solution.lux(grid.points, grid.normals))
    print(f"moved by {i * step:.1f} m: Em {stats.Em:.0f} lux, U0 {stats.U0:.2f}")
    best = max(best, (stats.Em, i * step))
print(f"brightest at {best[1]:.1f} m")

with solution.edit() as e:  # back, as a drag: each frame shows what fits into its time
    for _ in range(4):
        e.move("desk", translate=(-step, 0, 0))
        frame = e.frame(50)
        print(f"frame: {frame['deferred']} things wait")
check = solution.check()
print(f"mesh as by a fresh solve: {check.mesh_identical}; lines: {check.lines_identical}; p95 {check.p95:.2%}")
