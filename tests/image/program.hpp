// Runs the program as a user would and keeps what it says.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

struct Outcome {
  int status = 0;        ///< Exit status; -N when signal N ended it.
  std::string out, err;  ///< Standard output and error.
};

/// Starts it; out and err are files.
pid_t start_program(const std::vector<std::string>& arguments, const std::filesystem::path& out,
                    const std::filesystem::path& err);
/// Waits for the end: the status as in Outcome.
int wait_for(pid_t process);
Outcome run_program(const std::vector<std::string>& arguments);

/// A test's own input (data/NAME), and a shared scene ("" when it is not there).
std::string data_file(const std::string& name);
std::string shared_scene(const std::string& name);

/// Parses; the test fails and gets null where it is no JSON.
nlohmann::json parse_json(const std::string& text);
