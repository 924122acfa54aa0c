import deltalux as dl

solution = dl.solve(dl.load("scenes/cornell/cornell.rad"), error=0.1)
with solution.edit() as e:
    e.light("lamp").scale = 0.5
print(f"dimmed in {e.report['time_s']['total']:.3f} s by {e.report['rays']} rays")
for name, lux in zip(("floor", "block"), solution.lux([(0.45, 0, 0.1), (0.2, 0.165, 0.2)], (0, 1, 0))):
    print(f"{name}: {lux:.0f} lux")
dl.save_image("cornell.png", solution.render("scenes/cornell/cornell.vf", size=(200, 200), samples=4))
