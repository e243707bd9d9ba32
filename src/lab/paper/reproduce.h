#pragma once
// `gnomon reproduce weiskopf2003 | dou2014`: a paper's figures and tables, reproduced by one command.
//
// A figure is a row of panels, each a picture with its label counts beside what the paper says it shows. All
// counts and times become numbers by name, and the paper's claims are judged from those alone (lab/paper/claims.h).

#include "lab/bench/bench.h"
#include "lab/compare/compare.h"
#include "lab/paper/claims.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

struct ReproduceOptions {
  std::string paper;             // weiskopf2003, dou2014
  std::string scene;             // a user's own; empty: the generated scene that each figure calls for
  std::filesystem::path outDir;  // empty: no pictures
  double scale = 1.0;            // of the sides of pictures, maps and volumes; 1 is what the papers have
  int repeats = 5;               // of what is timed
};

struct Panel {
  std::string name;             // "b"
  std::string what;             // "midpoint, nothing culled"
  std::string says;             // what the paper says it shows
  std::string counts;           // label counts, empty for what is exact
  std::string command;          // makes it again; empty where no command does
  std::string picture, labels;  // paths below outDir; empty: none
};

struct Figure {
  std::string id;     // "5"
  std::string title;  // what is seen, in kind
  std::string setup;  // scene, light, map, picture
  std::vector<Panel> panels;
  std::string svg;  // of a figure that is a diagram
};

struct PaperTable {
  std::string id;  // "1"
  std::string title, note;
  std::vector<std::string> columns;  // the first heads the rows' names
  std::vector<std::vector<std::string>> rows;
};

struct LeftOut {
  std::string what;  // "figure 7"
  std::string why;
};

struct Reproduction {
  std::string paper;     // weiskopf2003
  std::string citation;  // authors, title, where, year
  std::string device;
  std::vector<Figure> figures;
  std::vector<PaperTable> tables;
  std::vector<JudgedClaim> claims;
  std::vector<LeftOut> leftOut;
  Numbers numbers;
  std::vector<std::pair<std::string, std::string>> comparisons;  // name -> its results.json
  double scale = 1.0;                                            // of ReproduceOptions
  double seconds = 0.0;                                          // wall clock of all of it
};

// The papers there are.
const std::vector<std::string>& reproduciblePapers();

// Throws UsageError (no such paper, a scale outside 0.05..1) and WorldError. Shows progress.
Reproduction reproduce(const gpu::DeviceOptions& device, const ReproduceOptions& options);

// A line a claim, and what was left out; for a terminal.
std::string reproductionText(const Reproduction& reproduction);
// {"schema", "gnomon", "paper", "scale", "comparisons": [{name, results}], "tables", "numbers", "claims":
// [...], "left_out"}; docs/reproduce.md describes it.
std::string reproductionJson(const Reproduction& reproduction, const ReproduceOptions& options,
                             const std::string& command);
// One self-contained page. Pictures are read from options.outDir.
std::string reproductionHtml(const Reproduction& reproduction, const ReproduceOptions& options,
                             const std::string& command);

}  // namespace gnomon
