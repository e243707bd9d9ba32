#include "lab/page/report_text.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace gnomon {

std::string grouped(uint64_t count) {
  std::string digits = std::to_string(count);
  for (size_t at = digits.size(); at > 3;) digits.insert(at -= 3, "\u202f");  // narrow, and does not break
  return digits;
}

std::string percent(double fraction) {
  return fmt::format("{:.4f}\u202f%", 100.0 * fraction);
}

std::string shortNumber(double value) {
  return fmt::format("{:.4g}", value);
}

std::string errorText(double fraction) {
  return fmt::format("{:.3g}\u202f%", 100.0 * fraction);
}

std::string rawNumber(double value) {
  return fmt::format("{}", value);
}

std::string vectorText(const glm::vec3& v) {
  return fmt::format("{:.4g}, {:.4g}, {:.4g}", shortest(v.x), shortest(v.y), shortest(v.z));
}

std::string lightText(const LightFacts& light) {
  std::string text = fmt::format("{} ({})", light.name.empty() ? "unnamed" : light.name, light.type);
  if (light.position) text += fmt::format(" at {} m", vectorText(*light.position));
  if (light.direction) text += fmt::format(" towards {}", vectorText(*light.direction));
  if (light.coneDegrees) text += fmt::format(", cone {:.4g}°", shortest(*light.coneDegrees));
  return text;
}

std::string mapText(const std::string& map, const std::string& light) {
  return light.empty() ? map : map + ", " + light;
}

std::string kindTitle(const std::string& kind) {
  const size_t space = kind.find(' ');
  if (kind.starts_with("frame ")) return "Frame " + kind.substr(space + 1);
  if (space != std::string::npos) return kindTitle(kind.substr(0, space)) + ", " + kind.substr(space + 1);
  if (kind == "truth") return "Exact shadow";
  if (kind == "truth_beauty") return "Shaded with the exact shadow";
  std::string title = kind;
  std::ranges::replace(title, '_', ' ');
  if (!title.empty()) title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

bool isShaded(const std::string& kind) {
  return kind == "medium" || kind.starts_with("frame ") || kind.find("beauty") != std::string::npos;
}

std::string cellText(const FieldNotes& notes, const std::optional<double>& value) {
  if (!value) return "–";
  switch (notes.kind) {
    case NumberKind::Count:
      return grouped(static_cast<uint64_t>(*value));
    case NumberKind::Share:
      return percent(*value);
    case NumberKind::Error:
      return errorText(*value);
    case NumberKind::Milliseconds:
      return fmt::format("{:.2f}", *value);
    case NumberKind::Plain:
      break;
  }
  return fmt::format("{:.4f}", *value);
}

}  // namespace gnomon
