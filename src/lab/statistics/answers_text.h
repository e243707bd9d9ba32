#pragma once
// Answers as text: for the terminal, for spreadsheets, for papers, for documentation.

#include "lab/statistics/answers.h"

#include <string>

namespace gnomon {

// The ranking, for the terminal; about `width` columns, 0: any.
std::string rankingText(const Answers& answers, size_t width = 0);
// A line a method and subset, with a head: tidy data.
std::string answersCsv(const Answers& answers);
// Tables for booktabs: the ranking, the pairs of the best method, the heat map.
std::string answersLatex(const Answers& answers);
// Everything but the pictures.
std::string answersJson(const Answers& answers);
// The tables of docs/findings.md: each between comments that name it.
std::string answersMarkdown(const Answers& answers);

// How many cases, scenes, methods and rows it is, and what is left out.
std::string factsText(const Answers& answers);
// How the intervals were made, in two sentences.
std::string howIntervals(const Answers& answers);
// "0.0123", as per cent, with three digits that count.
std::string perCentOf(double share);

}  // namespace gnomon
