// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_choice.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cayspin::simulation {

void MethodChoice::put_into(io::Integrator& integrator) const {
  integrator.method = method;
  integrator.generator = generator;
  integrator.isotropy = isotropy;
  integrator.sigma = sigma;
  integrator.rotation = rotation;
  integrator.compensated = compensated;
  integrator.substeps = std::max<std::int64_t>(1, substeps);
}

std::string MethodChoice::keys() const {
  auto text = fmt::format("method=\"{}\"", method->word);
  if (generator != io::Generator::standard)
    text += fmt::format(",generator=\"{}\"", io::to_string(generator));
  if (rotation != io::Rotation::cayley)
    text += fmt::format(",rotation=\"{}\"", io::to_string(rotation));
  if (isotropy == io::Isotropy::constant)
    text += fmt::format(",isotropy={{constant={}}}", sigma);
  else if (isotropy != io::Isotropy::zero)
    text += fmt::format(",isotropy=\"{}\"", io::to_string(isotropy));
  if (compensated) text += ",compensated=true";
  if (substeps > 1) text += fmt::format(",substeps={}", substeps);
  return text;
}

}  // namespace cayspin::simulation
