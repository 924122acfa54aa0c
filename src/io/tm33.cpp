#include "io/tm33.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <filesystem>
#include <iterator>
#include <optional>
#include <tuple>

#include "io/ies/complete.hpp"
#include "io/ies/parse.hpp"
#include "io/lower_case.hpp"
#include "io/number.hpp"
#include "io/tm33/superpose.hpp"
#include "io/trimmed.hpp"
#include "io/xml.hpp"

namespace deltalux::io {

namespace {

constexpr const char* kSchemaHint = "compare the file with the schema of ANSI/IES TM-33";
constexpr std::size_t kMostCandela = 20'000'000;  // of a luminaire [limit]
constexpr double kMostLumens = 1e15;              // of an emitter [limit]
constexpr double kDisagree = 1.1;                 // fluxes that differ by more contradict each other [limit]

class Tm33Reader {
 public:
  explicit Tm33Reader(const std::string& name) : name_(name) {}

  PhotometryFile read(const XmlElement& root);

 private:
  struct Sample {
    double h, v, candela;
    int line;
  };

  [[noreturn]] void fail(const XmlElement& at, const std::string& message, const char* hint = kSchemaHint) const {
    throw InputError(name_, at.line, message, hint);
  }
  void warn(const std::string& message) { warnings_.push_back(name_ + ": " + message); }

  double number(const XmlElement& element, std::string_view text) const;
  double numberOr(double otherwise, const XmlElement* element) const {
    return element ? number(*element, element->text) : otherwise;
  }
  bool flagOr(bool otherwise, const XmlElement* element) const;
  double angle(const XmlElement& element, const char* attribute) const;

  Photometry emitter(const XmlElement&);
  IesRecord record(const XmlElement& intensity);
  std::vector<Sample> samples(const XmlElement& intensity) const;
  PhotometricType typeOf(std::vector<Sample>&, const XmlElement& intensity) const;
  void fillGrid(std::vector<Sample>, const XmlElement& intensity, IesRecord&) const;
  void checkCounts(const XmlElement& intensity, const IesRecord&);
  void applySymmetry(const XmlElement& intensity, IesRecord&);
  void checkFlux(const XmlElement& emitter, bool absolute, Photometry&);
  void growOpening(const XmlElement& emitter);

  const std::string& name_;
  std::string goniometer_;  // its type, in small letters
  std::vector<std::string> warnings_;
  Vec3 least_{0}, most_{0};  // of all luminous areas: along C90, along C0, upwards [m]
  bool hasAreas_ = false;
};

double Tm33Reader::number(const XmlElement& element, std::string_view text) const {
  const std::string_view word = trimmed(text);
  const std::optional<double> value = parseDecimal(word);
  if (!value) fail(element, element.name + ": " + notANumber(word));
  return *value;
}

bool Tm33Reader::flagOr(bool otherwise, const XmlElement* element) const {
  if (!element) return otherwise;
  const std::string word = lowerCase(trimmed(element->text));
  if (word == "true" || word == "1") return true;
  if (word != "false" && word != "0") fail(*element, element->name + " is neither true nor false");
  return false;
}

double Tm33Reader::angle(const XmlElement& element, const char* attribute) const {
  const std::string* value = element.attribute(attribute);
  if (!value) fail(element, element.name + " has no angle " + attribute);
  return number(element, *value);
}

std::vector<Tm33Reader::Sample> Tm33Reader::samples(const XmlElement& intensity) const {
  std::vector<Sample> all;
  for (const XmlElement& element : intensity.children)
    if (element.name == "IntData")
      all.push_back({angle(element, "h"), angle(element, "v"), number(element, element.text), element.line});
  if (all.empty()) fail(intensity, "has no intensities (IntData)");
  return all;
}

/// By the angles; those of type C are brought into 0 to 360 degrees.
PhotometricType Tm33Reader::typeOf(std::vector<Sample>& all, const XmlElement& intensity) const {
  const bool below = std::ranges::any_of(all, [](const Sample& s) { return s.v < 0; });
  const bool sideways = std::ranges::any_of(all, [](const Sample& s) { return s.h < 0; });
  const bool typeA = goniometer_.ends_with('a'), typeB = goniometer_.ends_with('b');
  if ((below || sideways) && typeA) return PhotometricType::A;
  if ((below || sideways) && typeB) return PhotometricType::B;
  if (below) fail(intensity, "vertical angles below 0 are of goniometers of type A or B, and the file names none");
  for (Sample& s : all) {
    if (s.h < -180 || s.h > 360)
      throw InputError(name_, s.line, fmt::format("a horizontal angle is {} degrees", s.h), kSchemaHint);
    if (s.h < 0) s.h += 360;
  }
  return PhotometricType::C;
}

void Tm33Reader::fillGrid(std::vector<Sample> all, const XmlElement& intensity, IesRecord& record) const {
  std::vector<double>&h = record.horizontals, &v = record.verticals;
  for (const Sample& s : all) h.push_back(s.h), v.push_back(s.v);
  for (std::vector<double>* angles : {&h, &v}) {
    std::ranges::sort(*angles);
    angles->erase(std::unique(angles->begin(), angles->end()), angles->end());
  }
  std::ranges::stable_sort(all,
                           [](const Sample& a, const Sample& b) { return std::tie(a.h, a.v) < std::tie(b.h, b.v); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Sample& s = all[i];
    if (i > 0 && s.h == all[i - 1].h && s.v == all[i - 1].v) {
      if (s.candela == all[i - 1].candela) continue;
      throw InputError(name_, s.line, fmt::format("h {} v {} stands there twice", s.h, s.v), kSchemaHint);
    }
    const std::size_t at = record.candela.size();
    if (at == h.size() * v.size() || h[at / v.size()] != s.h || v[at % v.size()] != s.v)
      fail(intensity, fmt::format("the plane h {} has no intensity at v {}", h[at / v.size()], v[at % v.size()]),
           "give every plane the same vertical angles");
    record.candela.push_back(s.candela);
  }
  const std::size_t at = record.candela.size();
  if (at < h.size() * v.size())
    fail(intensity, fmt::format("the plane h {} has no intensity at v {}", h[at / v.size()], v[at % v.size()]),
         "give every plane the same vertical angles");
  if (v.size() < 2) fail(intensity, "has a single vertical angle");
}

void Tm33Reader::checkCounts(const XmlElement& intensity, const IesRecord& record) {
  const auto check = [&](const char* what, std::size_t found) {
    const double told = numberOr(0, intensity.child(what));
    if (told > 0 && told != static_cast<double>(found))
      warn(fmt::format("{} is {}, but there are {}", what, told, found));
  };
  check("NumberHorz", record.horizontals.size());
  check("NumberVert", record.verticals.size());
}

/// What Symm says has to be what the planes allow; completing them by their range is complete.hpp's.
void Tm33Reader::applySymmetry(const XmlElement& intensity, IesRecord& record) {
  const XmlElement* const symmetry = intensity.child("Symm");
  std::string word = symmetry ? lowerCase(symmetry->text) : "";
  std::erase_if(word, [](char c) { return !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9'); });
  if (word.starts_with("symm")) word.erase(0, 4);
  std::vector<double>& h = record.horizontals;
  const bool circle = h.back() - h.front() == 360 || (h.front() == 0 && h.back() > 180);
  const auto runs = [&](double first, double last) { return h.front() == first && h.back() == last; };
  if (word == "bi90" && std::ranges::none_of(h, [](double a) { return a > 90 && a < 270; }) && h.back() >= 270) {
    // From 270 over 0 to 90: mirrored in that plane they are 90 to 270 the other way, 0 and 360 the same plane.
    IesRecord mirrored = record;
    mirrored.horizontals.clear(), mirrored.candela.clear();
    for (int half = 0; half < 2; ++half)
      for (std::size_t i = h.size(); i-- > 0;) {
        const double turned = half == 0 ? 180 - h[i] : 540 - h[i];
        if ((half == 0) != (h[i] <= 90) || (h[i] == 360 && h.front() == 0)) continue;
        mirrored.horizontals.push_back(turned);
        const auto plane = record.candela.begin() + static_cast<std::ptrdiff_t>(i * record.verticals.size());
        mirrored.candela.insert(mirrored.candela.end(), plane,
                                plane + static_cast<std::ptrdiff_t>(record.verticals.size()));
      }
    record = std::move(mirrored);
    return;
  }
  const auto expect = [&](bool holds, const char* what) {
    if (!holds)
      fail(*symmetry,
           fmt::format("Symm is {}, but the planes run from {} to {}", trimmed(symmetry->text), h.front(), h.back()),
           what);
  };
  if (word == "full") expect(h.size() == 1 || circle, "it wants one plane");
  if (word == "quad") expect(circle || runs(0, 90) || runs(0, 180), "it wants planes from 0 to 90");
  if (word == "bi0") expect(circle || runs(0, 180), "it wants planes from 0 to 180");
  if (word == "bi90") expect(circle || runs(90, 270), "it wants planes from 90 to 270");
  if (word == "none" && h.size() > 1 && !circle)
    warn(fmt::format(
        "it says that there is no symmetry, but planes run from {} to {}; the others are their mirror images",
        h.front(), h.back()));
}

IesRecord Tm33Reader::record(const XmlElement& intensity) {
  IesRecord record;
  std::vector<Sample> all = samples(intensity);
  record.type = typeOf(all, intensity);
  record.anglesLine = all.front().line;
  fillGrid(std::move(all), intensity, record);
  checkCounts(intensity, record);
  if (record.type == PhotometricType::C) applySymmetry(intensity, record);
  const XmlElement* const multiplier = intensity.child("Multiplier");
  record.multiplier = numberOr(1, multiplier);
  if (!(record.multiplier > 0)) fail(*multiplier, "Multiplier is not positive", "set it to 1 if nothing else is known");
  mendCandela(name_, record);
  return record;
}

void Tm33Reader::checkFlux(const XmlElement& emitter, bool absolute, Photometry& photometry) {
  const double flux = luminousFlux(photometry);
  const double quantity = numberOr(1, emitter.child("Quantity"));
  constexpr double kMostLamps = 1e6;  // some programs write -1 as 4294967295 [limit]
  const double lamps = quantity >= 1 && quantity <= kMostLamps ? quantity : 1;
  const double rated = lamps * numberOr(0, emitter.child("RatedLumens"));
  const double told = numberOr(0, emitter.child("LuminousData", "LuminousFlux"));
  const auto agree = [](double a, double b) { return a <= kDisagree * b && b <= kDisagree * a; };
  const auto lumens = [](double value) { return std::llround(std::min(value, kMostLumens)); };
  if (told > 0 && !agree(flux, told)) {
    if (!absolute && rated > 0 && agree(flux * rated / 1000, told)) {
      for (double& candela : photometry.candela) candela *= rated / 1000;
      return warn(
          fmt::format("its intensities amount to its flux of {} lm if they are in candela per 1000 lm of its lamps; "
                      "taken so",
                      lumens(told)));
    }
    return warn(
        fmt::format("the intensities amount to {} lm, its LuminousFlux says {} lm", lumens(flux), lumens(told)));
  }
  if (!absolute && rated > 0 && flux > kDisagree * rated)
    warn(fmt::format(
        "the intensities amount to {} lm, its lamps to {} lm; check its Multiplier, and whether they are in "
        "candela per 1000 lm",
        lumens(flux), lumens(rated)));
}

/// Faces of C0 and C180 look along C0 and are as long as the luminaire, along C90.
void Tm33Reader::growOpening(const XmlElement& emitter) {
  const XmlElement* const areas = emitter.child("EmissionAreas");
  if (!areas) return;
  for (const XmlElement& face : areas->children)
    for (const XmlElement& area : face.children) {
      if (!area.name.ends_with("Area")) continue;
      const char* const names[] = {"Length", "Width", "Height"};
      const char* const offsets[] = {"LengthOffset", "WidthOffset", "HeightOffset"};
      Vec3 size(0), centre(0);
      for (int axis = 0; axis < 3; ++axis) {
        size[axis] = std::abs(numberOr(0, area.child(names[axis])));
        centre[axis] = numberOr(0, area.child(offsets[axis]));
      }
      if (size.x + size.y + size.z == 0) continue;
      if (flagOr(false, area.child("Circular")) && size.y == 0) size.y = size.x;  // one diameter is enough
      least_ = hasAreas_ ? glm::min(least_, centre - 0.5 * size) : centre - 0.5 * size;
      most_ = hasAreas_ ? glm::max(most_, centre + 0.5 * size) : centre + 0.5 * size;
      hasAreas_ = true;
    }
}

Photometry Tm33Reader::emitter(const XmlElement& emitter) {
  const XmlElement& intensity = *emitter.child("LuminousData", "LuminousIntensity");
  IesRecord measured = record(intensity);
  const bool absolute = flagOr(true, intensity.child("AbsolutePhotometry"));
  if (!absolute) {
    const double ballast = numberOr(1, emitter.child("BallastFactor"));
    if (ballast > 0)
      measured.multiplier *= ballast;
    else
      warn("the ballast factor is not positive; taken as 1");
  }
  if (emitter.child("TiltAngles"))
    warn("factors of tilted lamps are left out; the lamp is taken as in its test position");
  Photometry photometry = completePhotometry(measured, name_);
  std::ranges::move(measured.warnings, std::back_inserter(warnings_));
  if (!(luminousFlux(photometry) <= kMostLumens))
    fail(intensity, "its intensities are too large", "check its Multiplier");
  checkFlux(emitter, absolute, photometry);
  growOpening(emitter);
  return photometry;
}

PhotometryFile Tm33Reader::read(const XmlElement& root) {
  const bool known = root.name.starts_with("IESTM33") || root.name.starts_with("ATLA_S001") ||
                     root.name.starts_with("UNI11733") || root.name == "LuminaireOpticalData";
  if (!known) fail(root, "is no luminaire of TM-33: it is a <" + root.name.substr(0, 40) + ">", kSchemaHint);
  if (const XmlElement* type = root.child("Equipment", "Gonioradiometer", "Type"))
    goniometer_ = lowerCase(trimmed(type->text));
  PhotometryFile file;
  int dark = 0;
  for (const XmlElement& child : root.children) {
    if (child.name != "Emitter") continue;
    if (!child.child("LuminousData", "LuminousIntensity")) {
      ++dark;
      continue;
    }
    Photometry photometry = emitter(child);
    Photometry& sum = file.photometry;
    const std::size_t most =
        (sum.verticals.size() + photometry.verticals.size()) * (sum.horizontals.size() + photometry.horizontals.size());
    if (most > kMostCandela) fail(child, "its emitters together have too many angles", "thin out the angles");
    sum = sum.candela.empty() ? std::move(photometry) : superpose(sum, photometry);
  }
  if (file.photometry.candela.empty())
    fail(root, "no emitter has luminous intensities (LuminousData/LuminousIntensity)",
         "radiant and photon data alone do not tell how bright it is");
  if (dark > 0) warn(fmt::format("{} of its emitters have no luminous intensities and give no light", dark));
  file.photometry.opening = most_ - least_;
  file.warnings = std::move(warnings_);
  return file;
}

}  // namespace

bool isTm33(const std::string& name, std::string_view text) {
  const std::string extension = lowerCase(std::filesystem::path(name).extension().string());
  return extension == ".xml" || extension == ".tm33" || looksLikeXml(text);
}

PhotometryFile readTm33(std::string_view text, const std::string& name) {
  return Tm33Reader(name).read(parseXml(text, name));
}

}  // namespace deltalux::io
