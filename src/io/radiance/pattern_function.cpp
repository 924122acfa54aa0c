#include "io/radiance/pattern_function.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "io/image/formats.hpp"
#include "io/radiance/calc.hpp"
#include "io/radiance/data_table.hpp"
#include "io/radiance/function_library.hpp"
#include "io/radiance/sky_pattern.hpp"
#include "io/radiance/transform.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr double kFar = 1e10;  // the distance to what is lit, where a function asks for it [sentinel]

std::filesystem::path folderOfSource(const RadObject& object) {
  return object.where.file ? std::filesystem::path(*object.where.file).parent_path() : std::filesystem::path();
}

SourceFile openFile(const std::string& name, const RadObject& object, FileAccess& files) {
  if (auto file = files.open(name, folderOfSource(object))) return std::move(*file);
  throw inputError(object.where, "cannot find '" + name.substr(0, 100) + "'");
}

std::string functionText(const std::string& name, const RadObject& object, FileAccess& files) {
  if (name == ".") return {};
  if (auto file = files.open(name, folderOfSource(object))) return std::move(file->text);
  if (const auto known = functionFile(name)) return std::string(*known);
  throw inputError(object.where, "cannot find '" + name.substr(0, 100) + "'");
}

/// A1 to A10 of those that there are, AC, and arg(i).
std::string argumentDefinitions(const std::vector<double>& reals) {
  constexpr std::size_t kNamed = 10;  // [defined]
  std::array<char, 40> text;
  const auto shown = [&](double x) {
    std::snprintf(text.data(), text.size(), "(%.17g)", x);
    return std::string(text.data());
  };
  std::string result = "AC = " + std::to_string(reals.size()) + ";", choices = shown(double(reals.size()));
  for (const double x : reals) choices += "," + shown(x);
  for (std::size_t i = 0; i < std::max(kNamed, reals.size()); ++i)
    result += "A" + std::to_string(i + 1) + " = " + shown(i < reals.size() ? reals[i] : 0) + ";";
  return result + "arg(i) = select(i + 1," + choices + ");";
}

/// The functions of one pattern, and the variables that they read.
class Functions {
 public:
  Functions(const RadObject& object, const std::string& file, FileAccess& files, long& calls)
      : calc_(object.where, calls) {
    for (std::size_t i = 0; i < kNames.size(); ++i) variables_[i] = &calc_.bind(kNames[i]);
    calc_.define(standardFunctions());
    calc_.define(argumentDefinitions(object.reals));
    calc_.define(functionText(file, object, files));
  }

  void set(const PatternPoint& p, const Mat4& toPattern, const glm::dmat3& frame) {
    const Vec3 D = p.direction * frame, N = p.normal * frame, P(toPattern * glm::dvec4(p.position, 1));
    const std::array<double, kCount> values{D.x, D.y, D.z, N.x, N.y, N.z, P.x, P.y, P.z, p.cosine, kFar, kFar};
    for (std::size_t i = 0; i < kCount; ++i) *variables_[i] = values[i];
  }
  Calc& calc() { return calc_; }
  bool reads(std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin; i < end; ++i)
      if (calc_.reads(kNames[i])) return true;
    return false;
  }

 private:
  static constexpr std::size_t kCount = 12;  // [layout]
  static constexpr std::array<const char*, kCount> kNames{"Dx", "Dy", "Dz", "Nx",   "Ny", "Nz",
                                                          "Px", "Py", "Pz", "Rdot", "T",  "Ts"};
  Calc calc_;
  std::array<double*, kCount> variables_;
};

using Channels = std::vector<Calc::Function>;
using Values = std::function<glm::dvec3()>;

glm::dvec3 channels(const Channels& functions, const std::vector<double>& arguments) {
  if (functions.size() == 1) return glm::dvec3(functions[0](arguments));
  return {functions[0](arguments), functions[1](arguments), functions[2](arguments)};
}

/// brightfunc, colorfunc: variables of the function file.
Values functionValues(Calc& calc, std::span<const std::string> names) {
  auto functions = std::make_shared<Channels>();
  for (const std::string& name : names) functions->push_back(calc.function({}, name));
  return [functions] { return channels(*functions, {}); };
}

/// brightdata, colordata: data files at coordinates, through one function of all the values.
Values dataValues(Calc& calc, std::span<const std::string> names, std::vector<DataTable> tables,
                  std::span<const std::string> coordinates) {
  const std::vector<std::string> parameters =
      names.size() == 1 ? std::vector<std::string>{"v"} : std::vector<std::string>{"v_r", "v_g", "v_b"};
  std::string list;
  for (const std::string& parameter : parameters) list += (list.empty() ? "(" : ",") + parameter;
  auto functions = std::make_shared<Channels>(), at = std::make_shared<Channels>();
  for (const std::string& name : names) functions->push_back(calc.function(parameters, name + list + ")"));
  for (const std::string& x : coordinates) at->push_back(calc.function({}, x));
  return [functions, at, tables = std::move(tables)] {
    std::vector<double> coordinate, values;
    for (const auto& x : *at) coordinate.push_back(x({}));
    for (const DataTable& table : tables) values.push_back(valueAt(table, coordinate));
    return channels(*functions, values);
  };
}

/// The channels of a picture over u and v: from its lower left corner, the shorter side is 1.
std::vector<DataTable> tablesOf(const SourceFile& file) {
  const Image image = decodeHdr(file.text, file.name);
  const double side = std::min(image.width, image.height);
  const auto dimension = [&](int count) {
    return DataTable::Dimension{0.5 / side, (count - 0.5) / side, static_cast<std::size_t>(count), {}};
  };
  std::vector<DataTable> tables(3);
  for (int c = 0; c < 3; ++c) {
    DataTable& table = tables[static_cast<std::size_t>(c)];
    table.dimensions = {dimension(image.width), dimension(image.height)};
    for (int x = 0; x < image.width; ++x)
      for (int y = image.height; y-- > 0;) table.values.push_back(image.at(x, y)[c] * image.exposure);
  }
  return tables;
}

glm::dmat3 axesOf(const Mat4& matrix) {
  glm::dmat3 axes(matrix);
  for (int i = 0; i < 3; ++i) axes[i] = glm::normalize(axes[i]);
  return axes;
}

bool isFinite(const Mat4& matrix) {
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(matrix[i / 4][i % 4])) return false;
  return true;
}

}  // namespace

bool PatternFunction::understands(const RadObject& object) {
  return isSkyPattern(object) || object.typeName == "brightfunc" || object.typeName == "colorfunc" ||
         object.typeName == "brightdata" || object.typeName == "colordata" || object.typeName == "colorpict" ||
         object.typeName == "mixfunc";
}

PatternFunction::PatternFunction(const RadObject& object, FileAccess& files, long& calls) {
  if (isSkyPattern(object)) {
    const Vec3 up = zenithOf(object);
    frame_ = glm::dmat3(Frame(up).tangent, Frame(up).bitangent, up);
    DomeLight dome{up, kPi, Rgb(1.0f), UniformSky{}, up};
    std::visit([&](const auto& sky) { dome.distribution = sky; }, skyOf(object));
    value_ = [dome](const PatternPoint& p) { return glm::dvec3(skyRadiance(dome, p.direction)); };
    return;
  }
  const bool picture = object.typeName == "colorpict", data = object.typeName.ends_with("data") || picture;
  const std::size_t channels = object.typeName.starts_with("color") ? 3 : 1;
  const std::size_t file = picture ? channels + 1 : data ? 2 * channels : channels;  // where the function file stands
  std::span<const std::string> words(object.strings);
  constexpr std::size_t kMixed = 2;  // names of modifiers that a mixture has before the rest [layout]
  if (object.typeName == "mixfunc") words = words.subspan(std::min(words.size(), kMixed));
  if (words.size() <= file) throw inputError(object.where, "it has too few arguments");
  std::vector<DataTable> tables;
  for (std::size_t i = channels; i < file && !picture; ++i)
    tables.push_back(parseDataTable(openFile(words[i], object, files)));
  if (picture) tables = tablesOf(openFile(words[channels], object, files));
  const std::size_t coordinates = data ? tables[0].dimensions.size() : 0;
  for (const DataTable& table : tables)
    if (table.dimensions.size() != coordinates) throw inputError(object.where, "its data differ in their dimensions");
  if (words.size() < file + 1 + coordinates) throw inputError(object.where, "it has too few coordinates for its data");

  const auto options = words.subspan(file + 1 + coordinates);
  std::size_t used = 0;
  const Transform own = parseTransform(options, used, object.where);
  if (used != options.size())
    throw inputError(object.where, "'" + options[used].substr(0, 40) + "' is no transform option");
  const Mat4 toWorld = object.toWorld ? *object.toWorld * own.matrix : own.matrix;
  frame_ = axesOf(toWorld);
  const Mat4 toPattern = glm::inverse(toWorld);
  if (!isFinite(toPattern)) throw inputError(object.where, "its transform overflows");

  auto functions = std::make_shared<Functions>(object, words[file], files, calls);
  const auto names = words.first(channels);
  const Values values =
      data ? dataValues(functions->calc(), names, std::move(tables), words.subspan(file + 1, coordinates))
           : functionValues(functions->calc(), names);
  usesNormal_ = functions->reads(3, 6), usesPosition_ = functions->reads(6, 9), usesCosine_ = functions->reads(9, 10);
  usesDistance_ = functions->reads(10, 12);
  value_ = [functions, values, toPattern, frame = frame_](const PatternPoint& p) {
    functions->set(p, toPattern, frame);
    return values();
  };
}

}  // namespace deltalux::io::radiance
