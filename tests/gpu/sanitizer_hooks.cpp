// For the sanitizer build only, in every test program that loads a Vulkan driver.

// What is lost inside the drivers and layers, not by us. Vulkan objects of our own that are never destroyed
// are reported by the validation layers, which every GPU test has on.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libvulkan_lvp\n"
         "leak:libLLVM\n"
         "leak:libVkLayer\n";
}

// And not a word of what was suppressed: a program's messages are its own.
extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";
}

// Libraries are never unloaded, else a leak's module would have no name to match. The Vulkan loader calls this.
extern "C" int dlclose(void*) noexcept {
  return 0;
}
