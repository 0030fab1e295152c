-- Starts `desire lsp` for a program; g:desire_command says how, if `desire` is not on the path.
-- Neovim 0.7 has vim.lsp.start_client, 0.8 and newer vim.lsp.start.
vim.bo.commentstring = "-- %s"
vim.bo.shiftwidth, vim.bo.expandtab = 2, true

local file = vim.api.nvim_buf_get_name(0)
local config = {
  name = "desire",
  cmd = vim.g.desire_command or { "desire", "lsp" },
  root_dir = file ~= "" and vim.fn.fnamemodify(file, ":p:h") or vim.fn.getcwd(),
}

local function on_attach(_, buffer)
  local function map(keys, action)
    vim.keymap.set("n", keys, action, { buffer = buffer, silent = true })
  end
  map("K", vim.lsp.buf.hover)
  map("gd", vim.lsp.buf.definition)
  map("gr", vim.lsp.buf.references)
  map("<leader>rn", vim.lsp.buf.rename)
  map("<leader>ca", vim.lsp.buf.code_action)
  map("<leader>f", vim.lsp.buf.format or vim.lsp.buf.formatting)
  vim.bo[buffer].omnifunc = "v:lua.vim.lsp.omnifunc"
  vim.api.nvim_buf_create_user_command(buffer, "DesireRun", function()
    vim.lsp.buf.execute_command({ command = "desire.run", arguments = { vim.uri_from_bufnr(buffer) } })
  end, {})
  map("<leader>r", "<cmd>DesireRun<cr>")
end
config.on_attach = on_attach

if vim.lsp.start then
  vim.lsp.start(config)
else
  vim.g.desire_client = vim.g.desire_client or vim.lsp.start_client(config)
  if vim.g.desire_client then
    vim.lsp.buf_attach_client(0, vim.g.desire_client)
  end
end
