// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <string>

namespace cayspin::test {

/// While a DecimalComma exists, C++ writes 1234.5 as 1.234,5. C writes 1234,5 if localedef can make
/// a locale.
class DecimalComma {
 public:
  explicit DecimalComma(std::filesystem::path const& folder)
      : cpp_(std::locale::global(std::locale(std::locale::classic(), new Punctuation))),
        c_(std::setlocale(LC_ALL, nullptr)) {
    auto const make = "localedef -i de_DE -f UTF-8 '" + (folder / "de_DE.UTF-8").string() +
                      "' > '" + (folder / "localedef.log").string() + "' 2>&1";
    static_cast<void>(std::system(make.c_str()));
    ::setenv("LOCPATH", folder.c_str(), 1);
    has_c = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  }
  DecimalComma(DecimalComma const&) = delete;
  DecimalComma& operator=(DecimalComma const&) = delete;
  ~DecimalComma() {
    std::locale::global(cpp_);
    std::setlocale(LC_ALL, c_.c_str());
    ::unsetenv("LOCPATH");
  }

  /// True if C uses the comma, too.
  bool has_c = false;

 private:
  struct Punctuation final : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
    std::string do_truename() const override { return "wahr"; }
    std::string do_falsename() const override { return "falsch"; }
  };

  std::locale cpp_;
  std::string c_;
};

}  // namespace cayspin::test
