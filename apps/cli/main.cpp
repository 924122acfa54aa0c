#include <cstdio>

int main() {
  std::puts("deltalux " DELTALUX_VERSION);
  return 0;
}
