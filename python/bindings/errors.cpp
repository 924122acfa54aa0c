// Exceptions of the library as those of deltalux.errors.
#include <deltalux/error.hpp>
#include <string>

#include "bind.hpp"

namespace deltalux::python {

namespace py = pybind11;

namespace {

template <class... Arguments>
void raise(const char* name, const Arguments&... arguments) {
  const py::object type = py::module_::import("deltalux.errors").attr(name);
  PyErr_SetObject(type.ptr(), type(arguments...).ptr());
}

/// What stands in files need not be UTF-8.
py::str text(const std::string& bytes) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace"));
}

/// Nor need their names, which come back as os.fsdecode has them.
py::str fileName(const std::string& bytes) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeFSDefaultAndSize(bytes.data(), static_cast<Py_ssize_t>(bytes.size())));
}

}  // namespace

void bindErrors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      raise("InputError", text(error.message()), text(error.hint()), fileName(error.file()), error.line());
    } catch (const OutputError& error) {
      raise("OutputError", text(error.what()));
    } catch (const Interrupted&) {
      PyErr_SetNone(PyExc_KeyboardInterrupt);
    }
  });
}

}  // namespace deltalux::python
