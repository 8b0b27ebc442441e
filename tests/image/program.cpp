// Runs the program as a user would.
#include "program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "temporary_folder.hpp"

pid_t start_program(const std::vector<std::string>& arguments, const std::filesystem::path& out,
                    const std::filesystem::path& err) {
  std::vector<char*> pointers{const_cast<char*>(UMBRAGE_PROGRAM)};
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  const pid_t process = fork();
  if (process != 0) return process;
  // The validation layer leaks and is gone before the leak checker could know it by name; all other runs are checked.
  if (std::find(arguments.begin(), arguments.end(), "--validate") != arguments.end()) {
    const char* options = std::getenv("ASAN_OPTIONS");
    setenv("ASAN_OPTIONS", (std::string(options ? options : "") + ":detect_leaks=0").c_str(), 1);
  }
  const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(out_file, STDOUT_FILENO);
  dup2(err_file, STDERR_FILENO);
  execv(UMBRAGE_PROGRAM, pointers.data());
  _exit(127);
}

int wait_for(pid_t process) {
  int status = 0;
  EXPECT_EQ(waitpid(process, &status, 0), process);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

Outcome run_program(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const pid_t process = start_program(arguments, folder.file("out"), folder.file("err"));
  const int status = wait_for(process);
  return {status, read_all(folder.file("out")), read_all(folder.file("err"))};
}

std::string data_file(const std::string& name) { return UMBRAGE_TEST_DATA "/" + name; }

std::string shared_scene(const std::string& name) {
  const std::string path = UMBRAGE_SCENES_DIR "/" + name;
  return std::filesystem::exists(path) ? path : std::string();
}

nlohmann::json parse_json(const std::string& text) {
  nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
  EXPECT_FALSE(document.is_discarded()) << text.substr(0, 400);
  return document.is_discarded() ? nlohmann::json() : document;
}
