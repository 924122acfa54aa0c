"""Scenes from files and from plain data: what light they make, and what is refused, in which words."""

import math
import os
import unittest

import numpy as np
import support

import deltalux as dl

UP = (0, 0, 1)


def lit_floor(light, material=None, **more):
    """Illuminance data of a floor of 2 x 2 at z = 0 under one light."""
    return dl.load_dict(
        {
            "materials": {"floor": material or {"reflectance": 0}},
            "polygons": {"floor": {"vertices": support.square(), "material": "floor"}},
            "lights": {"light": light},
            **more,
        }
    )


def irradiance(scene, point=(0, 0, 0)):
    return dl.solve(scene, error=0.05).irradiance([point], UP)[0]


class Lights(unittest.TestCase):
    def test_a_point_falls_off_with_the_square_of_its_distance(self):
        E = irradiance(lit_floor({"kind": "point", "position": (0, 0, 2), "intensity": (8, 4, 2)}))
        np.testing.assert_allclose(E, (2, 1, 0.5), rtol=1e-3)

    def test_a_lambertian_point_is_that_of_cie_171(self):
        light = {"kind": "lambert", "position": (0, 0, 3), "direction": (0, 0, -2), "intensity": 1000 / 179}
        lux = dl.solve(lit_floor(light)).lux([(0, 0, 0), (0.5, 0, 0), (0.5, 0.5, 0)], UP)
        np.testing.assert_allclose(lux, (111.11, 105.21, 99.73), rtol=1e-3)

    def test_a_spot_shines_within_its_cone(self):
        light = {"kind": "spot", "position": (0, 0, 1), "direction": (0, 0, -1), "intensity": 1, "inner": 20, "outer": 30}
        E = dl.solve(lit_floor(light)).irradiance([(0, 0, 0), (0.7, 0, 0)], UP)
        np.testing.assert_allclose(E[0], 1, rtol=1e-3)
        np.testing.assert_array_equal(E[1], 0)

    def test_the_sun_brings_its_irradiance_times_the_cosine(self):
        E = irradiance(lit_floor({"kind": "sun", "towards": (0, 1, 1), "irradiance": (100, 90, 80)}))
        np.testing.assert_allclose(E, np.array((100, 90, 80)) / math.sqrt(2), rtol=1e-3)

    def test_a_uniform_sky_brings_pi_times_its_radiance(self):
        np.testing.assert_allclose(irradiance(lit_floor({"kind": "sky", "radiance": 2})), 2 * math.pi, rtol=0.02)

    def test_an_overcast_cie_sky_brings_seven_ninths_of_pi_times_the_zenith(self):
        E = irradiance(lit_floor({"kind": "sky", "radiance": 1, "cie": 1, "sun": (0, 1, 1)}))
        # L = (1 + 4 exp(-.7 / cos)) / (1 + 4 exp(-.7)); integrated over cosine by quadrature
        c = np.linspace(0, 1, 20001)[1:]
        expected = np.trapezoid if hasattr(np, "trapezoid") else np.trapz
        value = 2 * math.pi * expected((1 + 4 * np.exp(-0.7 / c)) / (1 + 4 * math.exp(-0.7)) * c, c)
        np.testing.assert_allclose(E, value, rtol=0.02)

    def test_a_measured_light_is_that_of_the_command_line(self):
        with support.folder() as folder:
            (folder / "flood.ies").write_text(
                "IESNA:LM-63-2002\nTILT=NONE\n1 1639 1 3 1 1 2 0 0 0\n1 1 100\n0 45 90\n0\n500 400 0\n"
            )
            scene = lit_floor({"kind": "ies", "file": folder / "flood.ies", "position": (0, 0, 2)})
            self.assertEqual(scene.lights, ("light",))
            np.testing.assert_allclose(dl.solve(scene).lux([(0, 0, 0)], UP), 500 / 4, rtol=1e-3)
            hung = dl.load(support.CORNELL, luminaires=[(folder / "flood.ies", (0.2, 0.5, 0.2))])
            self.assertIn("flood", hung.lights)

    def test_a_closed_box_that_glows_is_a_furnace(self):
        data = support.room(lights={})
        data["polygons"] = {"room": data["polygons"]["room"]}
        data["materials"]["white"] = {"reflectance": 0.5, "emission": 1}
        solution = dl.solve(dl.load_dict(data), error=0.05)
        E = solution.irradiance([(1, 1, 0), (0, 1.5, 1)], [(0, 0, 1), (3, 0, 0)])
        np.testing.assert_allclose(E, 2 * math.pi, rtol=0.03)  # pi L / (1 - rho)


class Surfaces(unittest.TestCase):
    def test_a_mesh_lights_as_the_polygon_does(self):
        light = {"kind": "point", "position": (0.3, 0, 1), "intensity": 1}
        corners = support.square()
        mesh = {"vertices": np.array(corners), "triangles": np.array([(0, 1, 2), (0, 2, 3)]), "material": "floor"}
        scene = lit_floor(light, polygons={}, meshes={"floor": mesh})
        np.testing.assert_allclose(irradiance(scene), irradiance(lit_floor(light)), rtol=1e-4)

    def test_glass_and_mirrors_do_what_they_do(self):
        light = {"kind": "point", "position": (0, 0, 2), "intensity": 4}
        pane = {"vertices": support.square(1.0), "material": "pane"}
        plain = irradiance(lit_floor(light))
        for material, share in (({"kind": "glass", "transmissivity": 1}, 0.92), ({"kind": "mirror", "reflectance": 1}, 0)):
            floor = {"vertices": support.square(), "material": "floor"}
            materials = {"floor": {"reflectance": 0}, "pane": material}
            E = irradiance(lit_floor(light, materials=materials, polygons={"floor": floor, "pane": pane}))
            np.testing.assert_allclose(E, share * plain, rtol=0.01, atol=1e-9)

    def test_gloss_and_bodies_of_glass_are_taken(self):
        data = support.room()
        data["materials"]["wood"] = {"reflectance": 0.3, "specular": 0.4, "roughness": 0.1}
        data["materials"]["ice"] = {"kind": "dielectric", "transmission": 0.9, "ior": 1.3}
        corners = [(x, y, z) for x in (2, 2.3) for y in (2, 2.3) for z in (0.1, 0.4)]
        sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        data["polygons"]["cube"] = [{"vertices": [corners[i] for i in side], "material": "ice"} for side in sides]
        solution = support.solved(dl.load_dict(data))
        self.assertGreater(solution.report["counts"]["particles"], 0)

    def test_names_units_and_views_stand_in_the_scene(self):
        view = {"position": (1, 1, 1), "direction": (1, 0, 0), "horizontal": 60}
        scene = dl.load_dict(support.room(views={"in": view}, metres_per_unit=0.5, efficacy=683))
        self.assertEqual(scene.objects, ("room", "table", "lamp"))
        self.assertEqual(scene.materials, ("white", "wood", "glow"))
        self.assertEqual(scene.lights, ("spot", "lamp"))
        self.assertEqual((scene.views, scene.surfaces), (("in",), 8))
        self.assertEqual((scene.metres_per_unit, scene.efficacy), (0.5, 683))
        np.testing.assert_array_equal(scene.bounds, [(0, 0, 0), (3, 3, 2)])

    def test_coordinates_of_a_site_are_kept(self):
        far = np.array((4.5e6, 2.5e6, 100.0))
        data = support.room(lights={})
        for shapes in data["polygons"].values():
            for shape in shapes if isinstance(shapes, list) else [shapes]:
                shape["vertices"] = np.array(shape["vertices"]) + far
        near, away = support.solved(dl.load_dict(support.room(lights={}))), support.solved(dl.load_dict(data))
        point = np.array([(1.0, 1.0, 0.7)])
        np.testing.assert_allclose(away.lux(point + far, UP), near.lux(point, UP), rtol=0.02)
        np.testing.assert_allclose(away.mesh().vertices.min(axis=0), far, atol=1e-6)


class Refused(unittest.TestCase):
    def refused(self, change, *words):
        data = support.room()
        change(data)
        with self.assertRaises(dl.InputError) as caught:
            dl.load_dict(data)
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_a_message_says_where_and_what(self):
        table = lambda **more: lambda d: d["polygons"]["table"].update(more)  # noqa: E731
        wood = lambda **more: lambda d: d["materials"]["wood"].update(more)  # noqa: E731
        spot = lambda **more: lambda d: d["lights"]["spot"].update(more)  # noqa: E731
        at_table = "scene['polygons']['table']"
        self.refused(table(material="woot"), at_table, "'woot'", "nearest: wood")
        self.refused(table(vertices=[(0, 0), (1, 0), (1, 1)]), at_table + "['vertices']", "(3, 2)", "(V, 3)")
        self.refused(table(vertices=[(0, 0, 0), (1, 0, 0), (2, 0, 0)]), at_table, "no area")
        self.refused(table(vertices=[(0, 0, 0), (1, 0, math.nan), (1, 1, 0)]), "not finite in row 1")
        self.refused(table(vertices="a square"), at_table + "['vertices']", "no number")
        self.refused(table(vertises=1), "unknown key 'vertises'", "vertices")
        self.refused(wood(reflectance=1.2), "scene['materials']['wood']['reflectance']", "0 to 1")
        self.refused(wood(reflectance=(0.1, 0.2)), "neither one number nor three")
        self.refused(wood(reflectance=0.7, specular=0.5), "reflects more than it receives")
        self.refused(wood(kind="wood"), "'wood'", "one of opaque, mirror, glass, dielectric")
        self.refused(wood(both_sides=True), "both_sides", "emission")
        self.refused(spot(intensity=-1), "scene['lights']['spot']['intensity']", "not negative")
        self.refused(spot(direction=(0, 0, 0)), "['direction'] has no length")
        self.refused(spot(inner=60), "['inner']", "from 0 to 40")
        self.refused(spot(kind=None), "['kind'] is missing", "point, lambert, spot, ies, sun, sky")
        self.refused(lambda d: d["lights"]["spot"].pop("position"), "has no 'position'")
        self.refused(lambda d: d.update(meshs={}), "unknown key 'meshs'", "nearest: meshes")
        self.refused(lambda d: d.update(up=(0, 0)), "scene['up']", "three finite numbers")
        self.refused(lambda d: d.update(lights=[1]), "scene['lights'] is a dictionary")
        self.refused(lambda d: d.update(metres_per_unit=0), "metres_per_unit")
        self.refused(lambda d: d.update(lights={"l": {"kind": "ies", "file": "no.ies", "position": (0, 0, 0)}}), "no.ies")
        self.refused(lambda d: d.update(lights={"l": {"kind": "sky", "radiance": 1, "cie": 16}}), "1 to 15")
        self.refused(lambda d: d.update(views={"v": {"position": (0, 0, 0), "direction": (0, 0, 1)}}), "scene['views']['v']")

    def test_triangles_are_looked_at(self):
        def mesh(**more):
            corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
            return lambda d: d.update(meshes={"m": {"vertices": corners, "triangles": [(0, 1, 2)], "material": "wood", **more}})

        self.refused(mesh(triangles=[(0, 1, 2), (0, 1, 3)]), "scene['meshes']['m']['triangles']", "row 1", "there are 3")
        self.refused(mesh(triangles=[(0, 1, -1)]), "row 0")
        self.refused(mesh(triangles=[(0.0, 1.0, 2.0)]), "float64", "(T, 3)")
        self.refused(mesh(triangles=[(0, 1, 1)]), "no surface", "no triangle has an area")
        self.refused(mesh(normals=[(0, 0, 1)]), "['normals'] has shape (1, 3), not (3, 3)")
        self.refused(mesh(normals=[(0, 0, 1), (0, 0, 0), (0, 0, 1)]), "row without direction")

    def test_a_file_says_its_line(self):
        with support.folder() as folder:
            file = folder / "bad.rad"
            file.write_text("void plastic white 0 0 5 .5 .5 .5 0 0\nwhite polygon p 0 0 4 0 0 0 1\n")
            with self.assertRaises(dl.InputError) as caught:
                dl.load(file)
            error = caught.exception
            self.assertEqual((error.file, error.line), (str(file), 2))
            self.assertTrue(error.message and str(error).startswith(f"{file}:2: {error.message}"))
            said = support.command("info", file)
            self.assertEqual(said.stderr, f"deltalux: {error}\n")
            with self.assertRaises(dl.InputError):
                dl.load(folder / "none.rad")

    def test_names_of_files_may_be_any_bytes(self):
        with support.folder() as folder:
            name = os.fsdecode(os.fsencode(folder) + b"/sc\xffene.rad")
            with open(name, "w", encoding="utf-8") as file:
                file.write("void plastic white 0 0 5 .5 .5 .5 0 0\nwhite sphere s 0 0 4 0 0 0 1\n")
            self.assertEqual(dl.load(name).surfaces, 1)

    def test_what_is_ignored_is_a_warning(self):
        with support.folder() as folder:
            file = folder / "s.rad"
            file.write_text(
                "void texfunc p 4 dx dy dz bumps.cal 0 0\n"
                "p plastic white 0 0 5 .5 .5 .5 0 0\nwhite sphere s 0 0 4 0 0 0 1\n"
            )
            with self.assertWarns(dl.SceneWarning):
                scene = dl.load(file)
            self.assertIn("texfunc", scene.ignored)
            self.assertEqual(len(scene.warnings), 1)

    def test_an_option_that_a_format_does_not_heed_is_refused(self):
        with self.assertRaisesRegex(ValueError, "efficacy"):
            dl.load(support.CORNELL, efficacy=683)
        with self.assertRaisesRegex(ValueError, "metres"):
            dl.load(support.SOURCE / "scenes/furnace/furnace.gltf", metres_per_unit=0.3)


if __name__ == "__main__":
    support.main()
