#include "takt/core/arguments.h"

#include <charconv>
#include <optional>
#include <string>

#include "takt/core/binder.h"
#include "takt/core/surrogates.h"

namespace takt {
namespace {

constexpr std::string_view kBlank = " \t\r\n";

// Recursive descent over the text; stops at the first problem.
class FlowReader {
 public:
  FlowReader(std::string_view text, Binder& binder, ProblemList& problems)
      : text_(text), binder_(binder), problems_(problems) {}

  void Read() {
    Value();
    SkipBlanks();
    if (!problems_.full() && at_ < text_.size()) Fail("expected the end behind the closing bracket, found " + Rest());
  }

 private:
  char Peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  // Lines are only counted when a problem is reported: until then `column` holds the byte offset.
  Place Here() const { return {0, static_cast<int>(at_)}; }
  void SkipBlanks() { at_ = std::min(text_.find_first_not_of(kBlank, at_), text_.size()); }
  std::string Rest() const { return at_ < text_.size() ? Quoted(text_.substr(at_)) : "the end"; }
  void Fail(std::string message) { problems_.Add(Here(), binder_.Path(), std::move(message)); }

  void Value() {
    SkipBlanks();
    if (Peek() == '{') return Map();
    if (Peek() == '[') return List();
    Word(false);
  }

  void Map() {
    if (!binder_.BeginMap(Here())) return;
    ++at_;
    while (!problems_.full() && !Closes('}')) {
      if (Peek() == '{' || Peek() == '[') return Fail("expected a plain word as key, found " + Rest());
      Word(true);
      if (problems_.full()) return;
      SkipBlanks();
      if (Peek() != ':') return Fail("expected ': ' and a value behind the key, found " + Rest());
      ++at_;
      Value();
      if (!Separated('}')) return;
    }
    if (!problems_.full()) binder_.EndMap();
  }

  void List() {
    if (!binder_.BeginList(Here())) return;
    ++at_;
    while (!problems_.full() && !Closes(']')) {
      Value();
      if (!Separated(']')) return;
    }
    if (!problems_.full()) binder_.EndList();
  }

  bool Closes(char bracket) {
    SkipBlanks();
    if (Peek() != bracket) return false;
    ++at_;
    return true;
  }

  bool Separated(char bracket) {
    if (problems_.full()) return false;
    SkipBlanks();
    if (Peek() == ',') {
      ++at_;
    } else if (Peek() != bracket) {
      Fail(std::string("expected ',' or '") + bracket + "', found " + Rest());
    }
    return !problems_.full();
  }

  void Word(bool key) {
    const Place place = Here();
    const char first = Peek();
    if (first == '"') return DoubleQuoted(place);
    if (first == '\'') return SingleQuoted(place);
    if (first == '&') return Fail("expected a value, found an anchor (&); anchors are not read");
    if (first == '*') return Fail("expected a value, found an alias (*); write the value out");
    if (first == '!') return Fail("expected a value, found a tag (!); tags are not read");
    if (first != '\0' && std::string_view("|>%@`#?").find(first) != std::string_view::npos)
      return Fail("expected a value, found " + Rest());
    const std::string_view word = PlainWord();
    if (word.empty() && key) return Fail("expected a key, found " + Rest());
    if (word.empty() || word == "null" || word == "~") return binder_.Null(place);
    binder_.Scalar(place, word, false);
  }

  // Ends at a bracket, a comma, or a colon followed by a blank or bracket.
  std::string_view PlainWord() {
    const std::size_t start = at_;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (std::string_view("{}[],").find(c) != std::string_view::npos) break;
      if (c == ':' &&
          (at_ + 1 == text_.size() || std::string_view(" \t\r\n{}[],").find(text_[at_ + 1]) != std::string_view::npos))
        break;
      ++at_;
    }
    std::string_view word = text_.substr(start, at_ - start);
    return word.substr(0, word.find_last_not_of(kBlank) + 1);
  }

  void SingleQuoted(Place place) {
    const std::size_t start = ++at_;
    const std::size_t end = text_.find('\'', start);
    if (end == std::string_view::npos) return Fail("expected a closing quote, found the end");
    at_ = end + 1;
    if (Peek() != '\'') return binder_.Scalar(place, text_.substr(start, end - start), true);
    std::string value(text_.substr(start, end - start));
    while (Peek() == '\'') {
      const std::size_t next = text_.find('\'', at_ + 1);
      if (next == std::string_view::npos) return Fail("expected a closing quote, found the end");
      value += text_.substr(at_, next - at_);
      at_ = next + 1;
    }
    binder_.Scalar(place, value, true);
  }

  void DoubleQuoted(Place place) {
    const std::size_t start = ++at_;
    const std::size_t end = text_.find_first_of("\"\\", start);
    if (end != std::string_view::npos && text_[end] == '"') {
      at_ = end + 1;
      return binder_.Scalar(place, text_.substr(start, end - start), true);
    }
    std::string value;
    while (at_ < text_.size() && text_[at_] != '"') {
      if (text_[at_] != '\\') {
        value += text_[at_++];
      } else if (!Escape(value)) {
        return Fail("expected a known escape, found " + Rest());
      }
    }
    if (at_ == text_.size()) return Fail("expected a closing quote, found the end");
    ++at_;
    binder_.Scalar(place, value, true);
  }

  // Reads an escape at a backslash. Returns false if it is unknown; nothing is consumed.
  bool Escape(std::string& value) {
    if (at_ + 1 >= text_.size()) return false;
    if (const std::optional<char32_t> pair = ReadSurrogatePair(text_.substr(at_))) {
      AppendUtf8(value, *pair);
      at_ += kSurrogatePairBytes;
      return true;
    }
    const char kind = text_[at_ + 1];
    if (kind == 'x' || kind == 'u') {
      const std::size_t digits = kind == 'x' ? 2 : 4;
      if (at_ + 2 + digits > text_.size()) return false;
      const char* first = text_.data() + at_ + 2;
      std::uint32_t c = 0;
      const auto [end, error] = std::from_chars(first, first + digits, c, 16);
      if (error != std::errc() || end != first + digits || (c >= 0xD800 && c <= 0xDFFF)) return false;
      AppendUtf8(value, c);
      at_ += 2 + digits;
      return true;
    }
    constexpr std::string_view kEscapes = "\"\\/ntr0";
    constexpr std::string_view kMeanings{"\"\\/\n\t\r\0", 7};
    const std::size_t index = kEscapes.find(kind);
    if (index == std::string_view::npos) return false;
    value += kMeanings[index];
    at_ += 2;
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Binder& binder_;
  ProblemList& problems_;
};

}  // namespace

bool ReadArguments(const Type& type, void* object, std::string_view text, Problem* problem, std::size_t most_bytes) {
  ProblemList problems("arguments", 1);
  if (text.find_first_not_of(kBlank) == std::string_view::npos) text = "{}";
  if (text.size() > most_bytes) {
    problems.Add({}, {},
                 "expected at most " + std::to_string(most_bytes) + " bytes, found " + std::to_string(text.size()));
  } else if (CheckBytes(text, problems)) {
    Binder binder(type, object, problems);
    FlowReader(text, binder, problems).Read();
  }
  if (problems.size() == 0) return true;
  Place& place = problems.problems().front().place;
  if (place.line == 0) place = PlaceAt(text, static_cast<std::size_t>(place.column));
  if (problem) *problem = std::move(problems.problems().front());
  return false;
}

}  // namespace takt
