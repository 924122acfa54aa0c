"""Is there light enough on the desk, and evenly? The grid of EN 12464-1, and its numbers."""

import office

import deltalux as dl

solution = dl.solve(office.scene(), error=0.1)

desk = dl.SensorGrid.from_surface(solution, "desk.top", spacing=0.2)
plane = dl.SensorGrid.from_rectangle((0, 0, 0.75), (6, 0, 0), (0, 4, 0), border=0.5)
for name, grid in (("desk", desk), ("working plane", plane)):
    s = grid.stats(solution.lux(grid.points, grid.normals))
    print(f"{name}: {len(grid)} points, Em {s.Em:.0f} lux, {s.Emin:.0f} to {s.Emax:.0f}, U0 {s.U0:.2f}, Ud {s.Ud:.2f}")

dl.save_image("office.png", solution.render("door", size=(160, 120), samples=4))
