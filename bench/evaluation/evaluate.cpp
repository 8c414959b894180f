// SPDX-License-Identifier: MIT
// quadmark_evaluate: marks models with any scheme, damages them, reads the marks back: the worker of bench/evaluate.
//
//   quadmark_evaluate about                       version, compiler, libraries; schemes, their usual settings, what peers are
//   quadmark_evaluate run                         jobs from standard input, one a line; rows to standard output
//   quadmark_evaluate mark SCHEME SETTINGS PAYLOAD MODEL SEED OUT       writes a marked .glb or .ply; prints the mark's row
//   quadmark_evaluate read SCHEME SETTINGS PAYLOAD FILE SEED [PICTURE]  prints outcome, ber, unread and claim; the PNG of
//                                                                       an image as it was read
//   quadmark_evaluate write MODEL OUT             the model itself as `mark` writes it, without a mark
//   quadmark_evaluate chance SCHEME SETTINGS MARK MODEL FIRST COUNT   trials without the reader's mark (chance.h);
//                                                                       MARK "": of no scheme. Prints their claims by bins
//
// MODEL is as in models.h, the other words are as in bench/README.md; SETTINGS may be "" for the scheme's usual ones.
// Everything printed is a JSON object a line, with the columns of bench/README.md. A job is
//   {"scheme", "settings", "payload", "model", "seed", "mark": whether its row is wanted, "attacks": ["reorder", ...],
//    "pictures": {"crop:0.5": "file.png"}}
// and ends with the line {"done": true}, after {"error": "..."} where it could not be understood.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>
#include "attack_chain.h"
#include "chance.h"
#include "distortion_columns.h"
#include "models.h"
#include "peers/peers.h"
#include "quadmark/image.h"
#include "quadmark/io/model.h"
#include "quadmark/quadmark.h"
#include "trial.h"

namespace {

using namespace quadmark;
using namespace quadmark::bench;
using Json = nlohmann::ordered_json;

void print(const Json& line) {
  std::printf("%s\n", line.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
  std::fflush(stdout);
}

Json rowOf(const Trial& trial, const std::string& model, const std::string& attack) {
  return {{"scheme", trial.scheme->name()}, {"settings", trial.settings}, {"payload", trial.payloadName},
          {"model", model},                 {"seed", trial.seed},         {"attack", attack}};
}

void addMark(Json& row, const Mesh& original, const MarkedTrial& marked) {
  row["outcome"] = "written";
  row["vertices"] = original.vertexCount();
  if (marked.mark.capacityBits > 0) row["capacity"] = marked.mark.capacityBits;
  row["carriers"] = marked.mark.carriers;
  for (const auto& [column, value] : distortionColumns(original, marked.mesh)) row[column] = value;
}

void addJudgement(Json& row, const Judgement& judgement) {
  row["outcome"] = judgement.outcome;
  row["ber"] = judgement.bitErrorRate;
  row["unread"] = judgement.unread;
  row["claim"] = judgement.claim;
}

void addFailure(Json& row, const char* outcome, const Error& error) {
  row["outcome"] = outcome;
  row["note"] = error.message;
}

Status writeFile(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream stream(path, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) return Error{ErrorCode::io, "cannot write " + path};
  return okStatus();
}

// By the extension a PLY, or a GLB.
Status writeModel(const std::string& path, const NamedModel& model, const Mesh& mesh) {
  const auto bytes = path.ends_with(".ply") ? Result<std::vector<std::uint8_t>>(lab::writePly(mesh))
                                            : toGlb(model, mesh.positions);
  return bytes ? writeFile(path, *bytes) : Status(bytes.error());
}

Status writePicture(const std::string& path, const Trial& trial, const Judgement& judgement) {
  if (trial.payload.kind != TrialPayload::Kind::image) return Error{ErrorCode::badOption, "an ID has no picture"};
  return writeFile(path, encodePng({trial.payload.width, trial.payload.height, judgement.bits}, judgement.erased));
}

// A settings word that a scheme does not know is the caller's mistake; anything else says something about the scheme.
bool isRefusal(const Error& error) { return error.code == ErrorCode::capacity || error.code == ErrorCode::badMesh; }

Status runJob(const Json& job) {
  const auto trial = makeTrial(job.at("scheme"), job.value("settings", ""), job.at("payload"), job.at("seed"));
  if (!trial) return trial.error();
  std::vector<AttackChain> attacks;
  for (const std::string& text : job.value("attacks", std::vector<std::string>{})) {
    auto chain = parseAttacks(text);
    if (!chain) return chain.error();
    attacks.push_back(std::move(*chain));
  }
  const auto pictures = job.value("pictures", Json::object());
  const auto model = loadModel(job.at("model"));
  if (!model) return model.error();
  const auto marked = markTrial(*trial, model->mesh);
  if (!marked && !isRefusal(marked.error())) return marked.error();
  if (job.value("mark", true)) {
    Json row = rowOf(*trial, model->name, "mark");
    if (marked) addMark(row, model->mesh, *marked);
    else addFailure(row, "refused", marked.error());
    print(row);
  }
  for (const AttackChain& attack : attacks) {
    Json row = rowOf(*trial, model->name, attack.text);
    if (!marked) {
      addFailure(row, "refused", marked.error());
    } else if (const auto damaged = apply(attack, marked->mesh, trial->seed); !damaged) {
      if (damaged.error().code == ErrorCode::badOption) return damaged.error();
      addFailure(row, "failed", damaged.error());
    } else {
      const Judgement judgement = readTrial(*trial, *damaged);
      addJudgement(row, judgement);
      if (pictures.contains(attack.text))
        if (const Status wrote = writePicture(pictures[attack.text], *trial, judgement); !wrote) return wrote.error();
    }
    print(row);
  }
  return okStatus();
}

int runJobs() {
  for (std::string line; std::getline(std::cin, line);) {
    if (line.empty()) continue;
    try {  // the JSON library throws what is missing or of another type
      if (const Status ran = runJob(Json::parse(line)); !ran) print({{"error", ran.error().message}});
    } catch (const Json::exception& error) {
      print({{"error", error.what()}});
    }
    print({{"done", true}});
  }
  return 0;
}

int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

int about() {
  Json list = Json::array();
  for (const auto& scheme : schemes()) {
    Json one = {{"name", scheme->name()}, {"usualSettings", scheme->usualSettings()}};
    if (const auto* peer = dynamic_cast<const Peer*>(scheme.get())) {
      const PeerInfo info = peer->info();
      one["peer"] = {{"authors", info.authors}, {"title", info.title},     {"venue", info.venue},
                     {"year", info.year},       {"blind", info.blind},     {"carrier", info.carrier},
                     {"settings", info.settings}, {"decided", info.decided}, {"validation", info.validation}};
    }
    list.push_back(one);
  }
#ifdef __clang__
  const std::string compiler = __VERSION__;
#else
  const std::string compiler = "g++ " __VERSION__;
#endif
  const auto dotted = [](int a, int b, int c) { return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c); };
  const Json libraries = {
      {"Eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"meshoptimizer", dotted(MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION / 10 % 100, MESHOPTIMIZER_VERSION % 10)},
      {"nlohmann-json",
       dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)}};
  print({{"version", version()}, {"compiler", compiler}, {"libraries", libraries}, {"schemes", list}});
  return 0;
}

int mark(const Trial& trial, const std::string& modelName, const std::string& out) {
  const auto model = loadModel(modelName);
  if (!model) return fail(model.error());
  Json row = rowOf(trial, model->name, "mark");
  const auto marked = markTrial(trial, model->mesh);
  if (!marked && !isRefusal(marked.error())) return fail(marked.error());
  if (marked) {
    if (const Status wrote = writeModel(out, *model, marked->mesh); !wrote) return fail(wrote.error());
    addMark(row, model->mesh, *marked);
  } else {
    addFailure(row, "refused", marked.error());
  }
  print(row);
  return 0;
}

int read(const Trial& trial, const std::string& file, const std::string& picture) {
  const auto model = loadModel(file);
  if (!model) return fail(model.error());
  const Judgement judgement = readTrial(trial, model->mesh);
  if (!picture.empty())
    if (const Status wrote = writePicture(picture, trial, judgement); !wrote) return fail(wrote.error());
  Json row = Json::object();
  addJudgement(row, judgement);
  print(row);
  return 0;
}

int write(const std::string& name, const std::string& out) {
  const auto model = loadModel(name);
  if (!model) return fail(model.error());
  if (const Status wrote = writeModel(out, *model, model->mesh); !wrote) return fail(wrote.error());
  print({{"vertices", model->mesh.vertexCount()}});
  return 0;
}

int chance(const std::vector<std::string>& words) {
  const auto model = loadModel(words[4]);
  if (!model) return fail(model.error());
  const auto number = [&](std::size_t at) { return std::strtoull(words[at].c_str(), nullptr, 10); };
  const auto bins = countChance({words[1], words[2], words[3], number(5), number(6)}, model->mesh);
  Json line = Json::object();
  if (bins) {
    for (const auto& [bin, content] : *bins)
      line["bins"][std::to_string(bin)] = {{"trials", content.trials}, {"matches", content.matches}};
  } else if (isRefusal(bins.error())) {
    addFailure(line, "refused", bins.error());
  } else {
    return fail(bins.error());
  }
  print(line);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const std::string command = words.empty() ? "" : words[0];
  if (command == "about" && words.size() == 1) return about();
  if (command == "run" && words.size() == 1) return runJobs();
  if (command == "write" && words.size() == 3) return write(words[1], words[2]);
  if (command == "chance" && words.size() == 7) return chance(words);
  if ((command == "mark" && words.size() == 7) || (command == "read" && (words.size() == 6 || words.size() == 7))) {
    const auto trial = makeTrial(words[1], words[2], words[3], std::strtoull(words[5].c_str(), nullptr, 10));
    if (!trial) return fail(trial.error());
    if (command == "mark") return mark(*trial, words[4], words[6]);
    return read(*trial, words[4], words.size() == 7 ? words[6] : "");
  }
  std::fprintf(stderr, "usage: quadmark_evaluate about | run | write MODEL OUT | mark SCHEME SETTINGS PAYLOAD MODEL SEED OUT | "
                       "read SCHEME SETTINGS PAYLOAD FILE SEED [PICTURE] | "
                       "chance SCHEME SETTINGS MARK MODEL FIRST COUNT\n");
  return 2;
}
