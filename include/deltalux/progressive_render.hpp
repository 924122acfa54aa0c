#pragma once
// A picture that becomes better while one looks at it, and in the end is the one that render() makes, to the bit.
#include <deltalux/render.hpp>
#include <deltalux/solution_reader.hpp>
#include <memory>
#include <span>

namespace deltalux {

class ProgressiveRender {
 public:
  /// The reader must outlive this and must not be refreshed before it. `first`: by pixel, those that get their first
  /// ray before others do (mirrors, gloss, glass); empty: none.
  ProgressiveRender(const SolutionReader&, const View&, const RenderSettings&, std::vector<char> first = {});
  ~ProgressiveRender();
  ProgressiveRender(ProgressiveRender&&) noexcept;
  ProgressiveRender& operator=(ProgressiveRender&&) noexcept;

  /// Goes on for about so long, or until `progress` asks to stop; some pixels get a ray each time. True once every
  /// pixel has all of its rays.
  bool step(double milliseconds, const Progress* progress = nullptr);
  bool done() const;
  /// Means of the rays so far; where a pixel has none yet, 0.
  const Image& image() const;
  /// Rays so far, by pixel.
  std::span<const std::uint32_t> rays() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltalux
