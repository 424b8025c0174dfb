//! Empty: the tests stand beside this file.
