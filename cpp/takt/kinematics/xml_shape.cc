#include "takt/kinematics/xml_shape.h"

#include <vector>

namespace takt::kinematics {
namespace {

bool IsSpace(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}
bool BeginsName(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 128;
}
bool IsInName(char c) {
  return BeginsName(c) || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == ':';
}

class Scanner {
 public:
  Scanner(std::string_view text, std::size_t most_levels) : text_(text), most_levels_(most_levels) {}

  XmlCheck Run() {
    if (text_.find('\0') != std::string_view::npos) return XmlCheck::kMalformed;
    for (;;) {
      at_ = text_.find('<', at_);
      if (at_ == std::string_view::npos) break;
      if (!Markup()) return open_.size() > most_levels_ ? XmlCheck::kTooDeep : XmlCheck::kMalformed;
    }
    return open_.empty() && any_ ? XmlCheck::kGood : XmlCheck::kMalformed;
  }

 private:
  // Consumes from '<' to after its '>'. Returns false if it is not well formed, or there are too many levels.
  bool Markup() {
    if (Takes("<!--")) return Past("-->");
    if (Takes("<![CDATA[")) return Past("]]>");
    if (Takes("<?")) return Past("?>");
    if (Takes("<!")) return DocumentType();
    if (Takes("</")) return End();
    ++at_;
    return Begin();
  }

  bool DocumentType() {
    const std::size_t end = text_.find('>', at_);
    if (end == std::string_view::npos || text_.substr(at_, end - at_).find('[') != std::string_view::npos) return false;
    at_ = end + 1;
    return true;
  }

  bool Begin() {
    const std::string_view name = Name();
    if (name.empty()) return false;
    while (Space()) {
      if (at_ < text_.size() && BeginsName(text_[at_]) && !Attribute()) return false;
    }
    any_ = true;
    if (Takes("/>")) return true;
    open_.push_back(name);
    return open_.size() <= most_levels_ && Takes(">");
  }

  bool Attribute() {
    Name();
    Space();
    if (!Takes("=")) return false;
    Space();
    if (at_ >= text_.size() || (text_[at_] != '"' && text_[at_] != '\'')) return false;
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    if (end == std::string_view::npos || text_.substr(at_, end - at_).find('<') != std::string_view::npos) return false;
    at_ = end + 1;
    return true;
  }

  bool End() {
    const std::string_view name = Name();
    Space();
    if (open_.empty() || open_.back() != name) return false;
    open_.pop_back();
    return Takes(">");
  }

  std::string_view Name() {
    const std::size_t begin = at_;
    if (at_ < text_.size() && BeginsName(text_[at_])) {
      while (at_ < text_.size() && IsInName(text_[at_])) ++at_;
    }
    return text_.substr(begin, at_ - begin);
  }
  // Returns true if there was any.
  bool Space() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && IsSpace(text_[at_])) ++at_;
    return at_ > begin;
  }
  bool Takes(std::string_view what) {
    if (!text_.substr(at_).starts_with(what)) return false;
    at_ += what.size();
    return true;
  }
  bool Past(std::string_view what) {
    const std::size_t end = text_.find(what, at_);
    if (end == std::string_view::npos) return false;
    at_ = end + what.size();
    return true;
  }

  const std::string_view text_;
  const std::size_t most_levels_;
  std::size_t at_ = 0;
  std::vector<std::string_view> open_;  // elements, the outermost first
  bool any_ = false;                    // an element has been found
};

}  // namespace

XmlCheck ShapeOf(std::string_view text, std::size_t most_levels) {
  return Scanner(text, most_levels).Run();
}

}  // namespace takt::kinematics
