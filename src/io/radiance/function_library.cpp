#include "io/radiance/function_library.hpp"

namespace deltalux::io::radiance {

namespace {

// "True" is above 0; comparisons are differences. min and max are calc's own.
constexpr std::string_view kStandard = R"(
DEGREE = PI / 180;  FTINY = 1e-7;

Acos(c) = acos(min(max(c, -1), 1));
Asin(s) = asin(min(max(s, -1), 1));
Atan2(y, x) = if(abs(x) + abs(y), atan2(y, x), 0);
Exp(x) = if(x + 100, exp(x), 0);
Sqrt(x) = sqrt(max(x, 0));

abs(x) = max(x, -x);
sgn(x) = if(x, 1, if(-x, -1, 0));
sq(x) = x ^ 2;
bound(low, x, high) = max(low, min(x, high));
linterp(t, from, to) = from + t * (to - from);
frac(x) = x - floor(x);
mod(x, d) = d * frac(x / d);
tri(x, d) = abs(mod(x + d, 2 * d) - d);

and(p, q) = if(p, q, p);
or(p, q) = if(p, p, q);
not(p) = if(p, -1, 1);
inside(low, x, high) = min(x - low, high - x);

noop(v) = v;
noneg(v) = max(v, 0);
clip(v) = min(max(v, 0), 1);
red(r, g, b) = noneg(r);    clip_r(r, g, b) = clip(r);
green(r, g, b) = noneg(g);  clip_g(r, g, b) = clip(g);
blue(r, g, b) = noneg(b);   clip_b(r, g, b) = clip(b);
grey(r, g, b) = noneg(0.265074126 * r + 0.670114631 * g + 0.064811243 * b);
clipgrey(r, g, b) = min(grey(r, g, b), 1);
fade(near, far, d) = far + if(16 - d, (near - far) / (1 + d ^ 2), 0);

D(i) = select(i, Dx, Dy, Dz);
N(i) = select(i, Nx, Ny, Nz);
P(i) = select(i, Px, Py, Pz);
)";

// Angles of the light that leaves a luminaire aimed at -z, in degrees: theta from the aim, phi from +x towards -y. D is
// the direction against the light. A1 multiplies; A2 to A4 are the sides of a box along x, y and z, A2 and A3 diameter
// and height of a cylinder along z: candela divided by the area seen from there is luminance.
constexpr std::string_view kSource = R"(
src_theta = Acos(Dz) / DEGREE;
src_phi = mod(Atan2(Dy, -Dx) / DEGREE, 360);
src_phi2 = 180 - abs(180 - src_phi);
src_phi4 = 90 - abs(90 - src_phi2);

srcB_vert = atan(-Dx / Dz) / DEGREE;
srcB_horiz = Asin(Dy) / DEGREE;
srcB_vert2 = abs(srcB_vert);
srcB_horiz2 = abs(srcB_horiz);

corr(v) = if(AC, A1, 1) * v;
flatcorr(v) = corr(v) / Rdot;
boxcorr(v) = corr(v) / (A3 * A4 * abs(Dx) + A2 * A4 * abs(Dy) + A2 * A3 * abs(Dz));
cylcorr(v) = corr(v) / (A2 * A3 * Sqrt(1 - Dz ^ 2) + PI / 4 * A2 ^ 2 * abs(Dz));

off_x = noneg(abs(Px - Ts * Dx) - A2 / 2);
off_y = noneg(abs(Py - Ts * Dy) - A3 / 2);
off_z = noneg(abs(Pz - Ts * Dz) - A4 / 2);
lboxcorr(v) = corr(v) * Ts / (A3 * A4 * off_x + A2 * A4 * off_y + A2 * A3 * off_z);
)";

// Pictures that lie in the x-y plane, the shorter side 1 long: once, side by side, and mirrored at every edge. A1 is
// height over width.
constexpr std::string_view kPicture = R"(
pic_aspect = if(AC, A1, 1);
pic_u = Px;  pic_v = Py;
square_u = Px * max(1, 1 / pic_aspect);  square_v = Py * max(1, pic_aspect);
tile_u = mod(Px, max(1, 1 / pic_aspect));  tile_v = mod(Py, max(1, pic_aspect));
match_u = tri(Px, max(1, 1 / pic_aspect));  match_v = tri(Py, max(1, pic_aspect));
)";

}  // namespace

std::string_view standardFunctions() { return kStandard; }

std::optional<std::string_view> functionFile(std::string_view name) {
  const std::size_t slash = name.find_last_of('/');
  const std::string_view file = name.substr(slash == std::string_view::npos ? 0 : slash + 1);
  if (file == "source.cal") return kSource;
  if (file == "picture.cal") return kPicture;
  return std::nullopt;
}

}  // namespace deltalux::io::radiance
