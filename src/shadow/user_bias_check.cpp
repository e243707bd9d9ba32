#include "shadow/user_bias_check.h"

#include "base/child.h"
#include "base/error.h"
#include "base/message.h"
#include "gpu/glsl_words.h"
#include "gpu/program.h"
#include "gpu/shader_compiler.h"
#include "gpu/spirv_cache.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace {

// glslang takes a third of a second and 30 MiB for the sample. What it makes is kept in the shader cache.
constexpr ChildLimits kCompilerLimits{.bytes = 1 << 30, .seconds = 20, .usesFiles = true};
// lavapipe's compiler takes 3 s for an array of 2,000 floats, 14 s for 20,000, more than 100 s for 100,000.
constexpr uint64_t kMostValues = 4096;
// Drivers write functions out wherever they are called: of lines that each call the one before twice, lavapipe takes
// 1.3 s and 0.4 GiB for 2^12 calls, 10 s and 1.1 GiB for 2^14, more than 100 s and 7 GiB for 2^17. This allows 2^12.
constexpr uint64_t kMostInstructions = 100000;

class LoopSearch {
 public:
  explicit LoopSearch(std::vector<gpu::Word> words) : words_(std::move(words)) {}

  int line() const {
    for (size_t i = 0; i < words_.size(); ++i)
      if (is(i, "do") ? isEndlessDo(i) : (is(i, "while") || is(i, "for")) && isEndless(i)) return words_[i].line;
    return 0;
  }

 private:
  bool is(size_t i, const char* text) const { return i < words_.size() && words_[i].text == text; }

  // Behind the bracket that closes the one at `i`.
  size_t behind(size_t i, const char* open, const char* close) const {
    int depth = 0;
    for (; i < words_.size(); ++i) {
      depth += is(i, open) ? 1 : is(i, close) ? -1 : 0;
      if (depth == 0) return i + 1;
    }
    return i;
  }
  size_t behindStatement(size_t i) const {
    if (is(i, "{")) return behind(i, "{", "}");
    if (is(i, "do")) return behind(behindStatement(i + 1) + 1, "(", ")") + 1;
    if (is(i, "for") || is(i, "while") || is(i, "switch")) return behindStatement(behind(i + 1, "(", ")"));
    if (is(i, "if")) {
      const size_t then = behindStatement(behind(i + 1, "(", ")"));
      return is(then, "else") ? behindStatement(then + 1) : then;
    }
    while (i < words_.size() && !is(i, ";")) ++i;
    return i + 1;
  }
  bool isTrue(size_t begin, size_t end) const {
    while (is(begin, "(") && behind(begin, "(", ")") == end) ++begin, --end;
    return end == begin + 1 &&
           (is(begin, "true") ||
            (std::isdigit(static_cast<unsigned char>(words_[begin].text[0])) != 0 && !is(begin, "0")));
  }
  // Out of the loop that this is in: a break within another loop or a switch only ends that.
  bool hasExit(size_t begin, size_t end) const {
    end = std::min(end, words_.size());
    for (size_t i = begin; i < end; ++i) {
      if (is(i, "break") || is(i, "return") || is(i, "discard")) return true;
      const bool isLoop = is(i, "for") || is(i, "while") || is(i, "do");
      if (!isLoop && !is(i, "switch")) continue;
      size_t within = is(i, "do") ? i + 1 : behind(i + 1, "(", ")");
      for (const size_t after = std::min(behindStatement(within), end); within < after; ++within)
        if (is(within, "return") || is(within, "discard")) return true;
      i = within - 1;
    }
    return false;
  }
  bool isEndless(size_t i) const {
    if (!is(i + 1, "(")) return false;
    const size_t body = behind(i + 1, "(", ")");
    size_t begin = i + 2, end = body - 1;
    if (is(i, "for")) {
      begin = behindStatement(begin);
      end = begin;
      while (end < words_.size() && !is(end, ";")) ++end;
      if (begin == end) return !hasExit(body, behindStatement(body));
    }
    // `do ... while (true);` is seen at its beginning.
    return !is(body, ";") && isTrue(begin, end) && !hasExit(body, behindStatement(body));
  }
  bool isEndlessDo(size_t i) const {
    const size_t end = behindStatement(i + 1);
    return is(end, "while") && isTrue(end + 2, behind(end + 1, "(", ")") - 1) && !hasExit(i + 1, end);
  }

  std::vector<gpu::Word> words_;
};

// How many scalars the largest type of a module holds, arrays being what can make it large. SPIR-V 1.6, 3.49.6: each
// instruction is a word with its length and opcode, then its operands.
uint64_t largestType(const std::vector<uint32_t>& spirv) {
  enum : uint32_t { kVector = 23, kMatrix = 24, kArray = 28, kStruct = 30, kConstant = 43 };
  std::map<uint32_t, uint64_t> sizes, constants;
  const auto sizeOf = [&](uint32_t id) { return sizes.contains(id) ? sizes[id] : 1; };
  uint64_t largest = 0;
  for (size_t i = 5; i < spirv.size();) {
    const uint32_t opcode = spirv[i] & 0xffffu, length = spirv[i] >> 16;
    if (length == 0 || length > spirv.size() - i) return UINT64_MAX;  // more operands than 16 bits count
    const uint32_t* word = &spirv[i];
    if (opcode == kConstant && length == 4) constants[word[2]] = word[3];
    if (opcode == kVector || opcode == kMatrix) sizes[word[1]] = word[3] * sizeOf(word[2]);
    if (opcode == kArray) sizes[word[1]] = std::min<uint64_t>(constants[word[3]] * sizeOf(word[2]), UINT32_MAX);
    if (opcode == kStruct)
      for (uint32_t member = 2; member < length; ++member) sizes[word[1]] += sizeOf(word[member]);
    if (length > 1 && sizes.contains(word[1])) largest = std::max(largest, sizes[word[1]]);
    i += length;
  }
  return largest;
}

// How many instructions the entry point and all that it calls have, written out at every call. SPIR-V 1.6, 3.49.9.
uint64_t inlinedInstructions(const std::vector<uint32_t>& spirv) {
  enum : uint32_t { kEntryPoint = 15, kFunction = 54, kFunctionEnd = 56, kFunctionCall = 57 };
  struct Function {
    uint64_t instructions = 0;
    std::vector<uint32_t> calls;
    std::optional<uint64_t> inlined;
  };
  std::map<uint32_t, Function> functions;
  uint32_t entry = 0;
  Function* current = nullptr;
  for (size_t i = 5; i < spirv.size();) {
    const uint32_t opcode = spirv[i] & 0xffffu, length = spirv[i] >> 16;
    if (length == 0 || length > spirv.size() - i) return UINT64_MAX;
    if (opcode == kEntryPoint) entry = spirv[i + 2];
    if (opcode == kFunction) current = &functions[spirv[i + 2]];
    if (current != nullptr) ++current->instructions;
    if (opcode == kFunctionCall && current != nullptr) current->calls.push_back(spirv[i + 3]);
    if (opcode == kFunctionEnd) current = nullptr;
    i += length;
  }
  // glslang has refused recursion.
  const std::function<uint64_t(uint32_t)> inlined = [&](uint32_t id) {
    Function& function = functions[id];
    if (function.inlined) return *function.inlined;
    uint64_t sum = function.instructions;
    for (const uint32_t callee : function.calls) sum = std::min<uint64_t>(sum + inlined(callee), UINT32_MAX);
    function.inlined = sum;
    return sum;
  };
  return inlined(entry);
}

// 0: nowhere. `next`: the word behind it, or null.
int lineOf(const std::string& source, const std::string& word, const char* next = nullptr) {
  const std::vector<gpu::Word> words = gpu::wordsOf(source);
  for (size_t i = 0; i < words.size(); ++i)
    if (words[i].text == word && (next == nullptr || (i + 1 < words.size() && words[i + 1].text == next)))
      return words[i].line;
  return 0;
}

[[noreturn]] void failResource(const UserBias& bias, const std::string& word) {
  throw WorldError(
      fmt::format("{}:{}: '{}' is a resource that nobody gives a bias; what it needs beside the map is a "
                  "parameter (//! knob:) or a constant",
                  printable(bias.path), std::max(lineOf(bias.source, word), 1), word));
}

// Buffers, textures and images that Gnomon's own shader does not have.
void checkResources(const UserBias& bias, const std::vector<uint32_t>& with, const std::vector<uint32_t>& without) {
  const auto own = gpu::reflect(without, VK_SHADER_STAGE_COMPUTE_BIT).bindings;
  for (const auto& binding : gpu::reflect(with, VK_SHADER_STAGE_COMPUTE_BIT).bindings)
    if (std::ranges::none_of(own,
                             [&](const auto& one) { return one.index == binding.index && one.name == binding.name; }))
      failResource(bias, binding.name);
}

// Throws where it is about what glslang finds when it links, and then knows no lines: recursion, push constants.
void explainLinkError(const UserBias& bias, const std::string& message) {
  if (message.find("Only one push_constant block") != std::string::npos) failResource(bias, "push_constant");
  constexpr std::string_view kRecursion = "Recursion detected:";
  const size_t at = message.find(kRecursion);
  if (at == std::string::npos) return;
  size_t begin = at + kRecursion.size();
  while (begin < message.size() && message[begin] == ' ') ++begin;
  const std::string function = message.substr(begin, message.find('(', begin) - begin);
  throw WorldError(fmt::format("{}:{}: '{}' calls itself, perhaps by way of another function; GLSL has no recursion",
                               printable(bias.path), lineOf(bias.source, function, "("), function));
}

void checkText(const UserBias& bias) {
  const std::vector<gpu::Word> words = gpu::wordsOf(bias.source);
  for (size_t i = 0; i + 2 < words.size(); ++i)
    if (words[i].text == "#" && words[i + 1].text == "define" && words[i + 2].text == "main")
      throw WorldError(fmt::format("{}:{}: 'main' is the shader's that calls the bias; give the macro another name",
                                   printable(bias.path), words[i].line));
  if (std::ranges::none_of(words, [](const gpu::Word& one) { return one.text == "userLit"; }))
    throw fileError(bias.path, "has no function userLit",
                    "define bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap)");
  if (const int line = endlessLoop(bias.source))
    throw WorldError(fmt::format(
        "{}:{}: nothing ends this loop, and then Vulkan may do anything: lose the device, or go on with any result; "
        "give it a break",
        printable(bias.path), line));
}

// Texts that have passed, with where the shaders around them come from: a change that is taken back, or a session that
// names a file once more, asks for no compiler.
class Passed {
 public:
  bool has(const gpu::Hash128& text) {
    const std::scoped_lock lock(mutex_);
    return texts_.contains(text);
  }
  void add(const gpu::Hash128& text) {
    const std::scoped_lock lock(mutex_);
    texts_.insert(text);
  }

 private:
  std::mutex mutex_;
  std::set<gpu::Hash128> texts_;
};

}  // namespace

int endlessLoop(const std::string& glsl) {
  return LoopSearch(gpu::wordsOf(glsl)).line();
}

void checkUserBias(const UserBias& bias) {
  checkText(bias);
  static Passed& passed = *new Passed;  // never destroyed: a thread may be here when the program ends
  const std::string shaders = gpu::shaderDirectory().string();
  const gpu::Hash128 text = gpu::hashText(shaders + '\n' + bias.source);
  if (passed.has(text)) return;
  const std::string sizes = runInChild({.file = bias.path,
                                        .name = kUserBiasWork,
                                        .arguments = {shaders, bias.path},
                                        .input = bias.source,
                                        .program = "gnomon-compiler"},
                                       kCompilerLimits);
  std::istringstream numbers(sizes);
  uint64_t values = 0, instructions = 0;
  numbers >> values >> instructions;
  if (values > kMostValues)
    throw fileError(bias.path, fmt::format("an array or structure in it has more than {} values", kMostValues),
                    "no driver compiles that in reasonable time; use a smaller one");
  if (instructions > kMostInstructions)
    throw fileError(
        bias.path,
        fmt::format("its functions, written out wherever they are called, have {} instructions, more than {}",
                    instructions, kMostInstructions),
        "no driver compiles that in reasonable time; let fewer functions call others more than once");
  passed.add(text);
}

std::string compiledUserBias(const std::vector<std::string>& arguments, std::string source) {
  if (!arguments.at(0).empty()) gpu::setShaderDirectory(arguments[0]);
  const std::unique_ptr<const UserBias> bias = readUserBias(arguments.at(1), source);
  try {
    const std::vector<uint32_t> with = gpu::compileShader(shaderWith(kVisibilityShader, bias.get()));
    const std::vector<uint32_t> without = gpu::compileShader(shaderWith(kVisibilityShader, nullptr));
    checkResources(*bias, with, without);
    const uint64_t all = inlinedInstructions(with);
    return fmt::format("{} {}", largestType(with), all - std::min(all, inlinedInstructions(without)));
  } catch (const WorldError& error) {
    explainLinkError(*bias, error.what());
    throw WorldError(inUsersWords(error.what(), *bias));
  }
}

}  // namespace gnomon
