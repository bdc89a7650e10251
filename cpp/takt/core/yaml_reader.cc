#include "takt/core/yaml_reader.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "takt/core/binder.h"
#include "takt/core/surrogates.h"

namespace takt {
namespace {

// Ends the parsing; the problem is already in the list.
struct Stop {};

// Converts yaml-cpp's marks (0-based, counting bytes) to positions and byte offsets of the text.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {
    starts_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') starts_.push_back(i + 1);
    }
  }
  std::size_t Offset(const YAML::Mark& mark) const {
    if (mark.is_null()) return 0;
    const std::size_t line = std::min(static_cast<std::size_t>(std::max(mark.line, 0)), starts_.size() - 1);
    return std::min(starts_[line] + static_cast<std::size_t>(std::max(mark.column, 0)), text_.size());
  }
  Place At(const YAML::Mark& mark) const {
    if (mark.is_null()) return {};
    const std::size_t start = starts_[std::min(static_cast<std::size_t>(std::max(mark.line, 0)), starts_.size() - 1)];
    return {mark.line + 1, PlaceAt(text_.substr(start, Offset(mark) - start), Offset(mark) - start).column};
  }
  // Returns true if the quoted text that begins here ends before the file does.
  bool IsClosed(const YAML::Mark& mark) const {
    const char quote = Byte(mark);
    if (quote != '"' && quote != '\'') return true;  // a block of text
    for (std::size_t i = Offset(mark) + 1; i < text_.size(); ++i) {
      if (quote == '"' && text_[i] == '\\') {
        ++i;
      } else if (text_[i] == quote) {
        if (quote == '"' || i + 1 == text_.size() || text_[i + 1] != quote) return true;
        ++i;
      }
    }
    return false;
  }
  char Byte(const YAML::Mark& mark) const {
    const std::size_t offset = Offset(mark);
    return offset < text_.size() ? text_[offset] : '\0';
  }

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;
};

class Handler : public YAML::EventHandler {
 public:
  Handler(Binder& binder, const Lines& lines, ProblemList& problems)
      : binder_(binder), lines_(lines), problems_(problems) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (anchor) return RefuseAnchor(mark);
    binder_.Null(lines_.At(mark));
    Check();
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    binder_.Refuse(lines_.At(mark), "expected a value, found an alias (*); write the value out");
    Check();
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    if (anchor) return RefuseAnchor(mark);
    if (IsTag(mark, tag)) return RefuseTag(mark);
    if (tag == "!") last_quoted_ = mark;
    binder_.Scalar(lines_.At(mark), UnmaskSurrogatePairs(value, lines_.Byte(mark) == '"'), tag == "!");
    Check();
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Tell(mark, tag, anchor);
    if (!binder_.BeginList(lines_.At(mark))) throw Stop();
    Check();
  }
  void OnSequenceEnd() override {
    binder_.EndList();
    Check();
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    Tell(mark, tag, anchor);
    if (!binder_.BeginMap(lines_.At(mark))) throw Stop();
    Check();
  }
  void OnMapEnd() override {
    binder_.EndMap();
    Check();
  }
  // yaml-cpp takes the end of the file for a closing quote.
  void CheckLastQuote() {
    if (!last_quoted_.is_null() && !lines_.IsClosed(last_quoted_)) {
      problems_.Add(lines_.At(last_quoted_), {}, "expected a closing quote, found the end of the file");
    }
  }

 private:
  static constexpr const char* kNoAnchor = "expected a value, found an anchor (&); anchors are not read";
  static constexpr const char* kNoTag = "expected a value, found a tag (!); tags are not read";

  // Quoted text has the tag "!", as does a plain word after a single "!".
  bool IsTag(const YAML::Mark& mark, const std::string& tag) const {
    return tag == "!" ? lines_.Byte(mark) == '!' : !tag.empty() && tag != "?";
  }
  void RefuseAnchor(const YAML::Mark& mark) {
    binder_.Refuse(lines_.At(mark), kNoAnchor);
    Check();
  }
  void RefuseTag(const YAML::Mark& mark) {
    binder_.Refuse(lines_.At(mark), kNoTag);
    Check();
  }
  // Reading continues inside mappings and lists with a problem, so that problems inside them are reported in the same
  // run.
  void Tell(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor) problems_.Add(lines_.At(mark), binder_.Path(), kNoAnchor);
    if (!anchor && !tag.empty() && tag != "?") problems_.Add(lines_.At(mark), binder_.Path(), kNoTag);
  }
  void Check() const {
    if (problems_.full()) throw Stop();
  }

  Binder& binder_;
  const Lines& lines_;
  ProblemList& problems_;
  YAML::Mark last_quoted_ = YAML::Mark::null_mark();
};

// Anything after the first document.
class SecondDocument : public YAML::EventHandler {
 public:
  SecondDocument(const Lines& lines, ProblemList& problems) : lines_(lines), problems_(problems) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    problems_.Add(lines_.At(mark), {}, "expected the end of the file, found a second document");
    throw Stop();
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  const Lines& lines_;
  ProblemList& problems_;
};

void Parse(const Type& type, void* object, std::string_view text, ProblemList& problems, SourceMap& source) {
  const Lines lines(text);
  Binder binder(type, object, problems, &source);
  Handler handler(binder, lines, problems);
  SecondDocument second(lines, problems);
  try {
    std::string masked(text);
    MaskSurrogatePairs(masked);
    std::istringstream stream{std::move(masked)};
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(handler)) {
      problems.Add({}, {}, "expected " + Expectation(type, nullptr) + ", found an empty file");
      return;
    }
    handler.CheckLastQuote();
    // A first call may end at the marker between documents without an event: call it once more.
    parser.HandleNextDocument(second);
    parser.HandleNextDocument(second);
  } catch (const Stop&) {
  } catch (const YAML::Exception& e) {
    problems.Add(lines.At(e.mark), binder.Path(),
                 "expected YAML, found an error in its form: " + UnmaskSurrogatePairs(e.msg, false));
  }
}

}  // namespace

std::vector<Problem> ReadYaml(const Type& type, void* object, std::string_view text, std::string_view file_name,
                              SourceMap& source) {
  ProblemList problems(file_name, kMaxProblems);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.size() > kMaxYamlBytes) {
    problems.Add({}, {}, "expected at most " + std::to_string(kMaxYamlBytes / 1'000'000) + " MB, found more");
  } else if (CheckBytes(text, problems)) {
    Parse(type, object, text, problems, source);
  }
  std::vector<Problem> found = std::move(problems.problems());
  if (found.size() == kMaxProblems) {
    found.push_back({std::string(file_name), found.back().place, {}, "too many problems; the rest was not read"});
  }
  return found;
}

std::optional<std::string> LoadText(const std::string& path, std::string& why) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  if (file) {
    text.resize(kMaxYamlBytes + 1);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (!file.bad()) return text;
  }
  why = "cannot read this file: " + std::system_category().message(errno);
  return std::nullopt;
}

}  // namespace takt
