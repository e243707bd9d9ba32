#pragma once
// `gnomon view --script`: what a person would do, a line each, played in a real window.

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

struct ScriptLine {
  int number = 0;  // in the file, from 1
  std::string verb;
  std::vector<std::string> words;  // after it
};

// What a verb takes, for --help and docs.
struct ScriptVerb {
  const char* name;
  int least, most;  // words; of a verb whose last word is a text, that is one
  bool endsInText;
  const char* takes;
  const char* sentence;
};
const std::vector<ScriptVerb>& scriptVerbs();

// Empty lines and what follows a # are passed over. Throws WorldError "file:line: ...".
std::vector<ScriptLine> readScript(const std::filesystem::path& path);
std::vector<ScriptLine> parseScript(const std::string& name, const std::string& text);

// Of a word of a line: throws WorldError that names the line.
double scriptNumber(const std::string& name, const ScriptLine& line, size_t word);
int scriptCount(const std::string& name, const ScriptLine& line, size_t word, int least, int most);
// Which of these a word is; the first where there is none.
size_t scriptChoice(const std::string& name, const ScriptLine& line, size_t word,
                    const std::vector<std::string>& choices);

}  // namespace gnomon
