// SPDX-License-Identifier: BSD-3-Clause
// The file that ParaView opens as the plugin. It needs no library of ParaView's, so that it can be
// opened by every version: one that it was not built for is told so in a sentence, instead of the
// name of a library that is missing. It then opens the plugin itself, which lies beside it.
#include <dlfcn.h>
#include <link.h>

#include <cstdio>
#include <cstring>
#include <string>

class vtkPVPlugin;

namespace
{

/// Version in the name of a library of ParaView's that the process has opened, such as
/// "libvtkRemotingCore-pv5.11.so.1"; empty if there is none.
std::string RunningVersion()
{
  std::string version;
  const auto look = [](dl_phdr_info* library, std::size_t, void* found) -> int
  {
    const char* const name = std::strstr(library->dlpi_name, "libvtkRemotingCore-pv");
    if (!name)
    {
      return 0;
    }
    const char* const first = name + std::strlen("libvtkRemotingCore-pv");
    static_cast<std::string*>(found)->assign(first, std::strspn(first, "0123456789."));
    return 1;
  };
  dl_iterate_phdr(look, &version);
  // The name goes on with ".so".
  version.erase(version.find_last_not_of('.') + 1);
  return version;
}

/// Folder of this file, with a slash at its end.
std::string OwnFolder()
{
  Dl_info own = {};
  if (!dladdr(reinterpret_cast<void*>(&OwnFolder), &own) || !own.dli_fname)
  {
    return {};
  }
  const std::string file = own.dli_fname;
  return file.substr(0, file.rfind('/') + 1);
}

/// Shows an error as ParaView shows its own, in the window of messages if there is one.
void Show(const std::string& sentence)
{
  // void vtkOutputWindowDisplayErrorText(const char*), of whichever VTK is in the process.
  using Display = void (*)(const char*);
  void* const display = dlsym(RTLD_DEFAULT, "_Z31vtkOutputWindowDisplayErrorTextPKc");
  if (display)
  {
    reinterpret_cast<Display>(display)(sentence.c_str());
    return;
  }
  std::fprintf(stderr, "%s\n", sentence.c_str());
}

} // namespace

/// Looked up by ParaView. Returns null, after an error was shown, when the plugin cannot be used.
extern "C" __attribute__((visibility("default"))) vtkPVPlugin* pv_plugin_instance()
{
  const std::string built = BANYAN_PARAVIEW_SERIES;
  const std::string running = RunningVersion();
  if (!running.empty() && running != built)
  {
    Show("Banyan was built for ParaView " + built + ", but this is ParaView " + running +
         ": install Banyan for " + running +
         ", or build it with ParaView_DIR set to this version.\n");
    return nullptr;
  }
  void* const plugin = dlopen((OwnFolder() + BANYAN_PLUGIN_FILE).c_str(), RTLD_LAZY);
  if (!plugin)
  {
    Show("Banyan was built for ParaView " + built +
         ", and a library that it needs is missing: " + dlerror() + "\n");
    return nullptr;
  }
  using Instance = vtkPVPlugin* (*)();
  return reinterpret_cast<Instance>(dlsym(plugin, "pv_plugin_instance"))();
}
